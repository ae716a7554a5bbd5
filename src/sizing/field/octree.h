#pragma once

#include <octafront/vec.h>

#include "base/core/parallel_arrays.h"
#include "sizing/field/octree_key.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace octafront {

/// The cube that the root of an octree stands for, in input units.
struct RootCube {
  Vec3 lo;
  double side = 1;

  /// The smallest cube about the centre of the box that holds it, larger by `margin` of its side all around.
  static RootCube around(const Box3& box, double margin);
  double unit() const { return side / OctreeKey::kSide; }
  Vec3 position(std::array<std::uint32_t, 3> units) const {
    return {lo.x + units[0] * unit(), lo.y + units[1] * unit(), lo.z + units[2] * unit()};
  }
  /// The finest cell that contains p; for points outside, the one nearest to it.
  OctreeKey cell(Vec3 p) const {
    const auto units = [this](double x, double low) {
      const double u = (x - low) / side * OctreeKey::kSide;
      if (!(u > 0)) return std::uint32_t{0};
      return u < OctreeKey::kSide ? static_cast<std::uint32_t>(u) : OctreeKey::kSide - 1;
    };
    return OctreeKey::containing(units(p.x, lo.x), units(p.y, lo.y), units(p.z, lo.z));
  }
  double side_of(OctreeKey key) const { return side / (1u << key.level()); }
  Vec3 corner_of(OctreeKey key) const { return position(key.corner()); }
  Vec3 center_of(OctreeKey key) const {
    const double half = 0.5 * side_of(key);
    return corner_of(key) + Vec3{half, half, half};
  }
};

/// A linear octree: the keys of its leaves, sorted. They cover the root cube and do not overlap. Copies share them.
class Octree {
 public:
  /// The root alone.
  Octree() : Octree(std::vector<OctreeKey>{OctreeKey::root()}) {}
  /// REQUIRES: the leaves are sorted and cover the root without overlap.
  explicit Octree(RawVector<OctreeKey> leaves);
  explicit Octree(const std::vector<OctreeKey>& leaves) : Octree(parallel_copy(leaves)) {}

  std::size_t size() const { return leaves_.size(); }
  OctreeKey leaf(std::size_t i) const { return leaves_[i]; }
  std::span<const OctreeKey> leaves() const { return leaves_; }
  int depth() const { return depth_; }

  /// Index of the leaf that contains the cell, or that it contains first. O(log) of the leaves in one cell of a lookup
  /// grid of about as many cells as leaves: some 20 to 50 ns.
  std::size_t find(OctreeKey cell) const;

  /// True if no two leaves that share a face, an edge or a corner differ by more than one level. O(leaves log leaves).
  bool is_balanced() const;

  /// Where the leaves do not cover the root once, in order, or find() does not find them (base/core/validate.h).
  std::optional<std::string> first_inconsistency() const;

 private:
  struct Arrays {
    RawVector<OctreeKey> leaves;
    RawVector<std::uint32_t> first;
  };
  std::shared_ptr<const Arrays> arrays_;
  std::span<const OctreeKey> leaves_;
  std::span<const std::uint32_t> first_;  ///< per cell of level grid_level_: the leaf that contains its first unit
  int grid_level_ = 0, depth_ = 0;
};

/// True if the keys are cells, sorted, that cover the root without overlap: what an Octree can be made of.
bool cover_the_root(std::span<const OctreeKey> leaves);

/// The cells of an octree that are divided, level by level. A set under construction: divide() may be called in any
/// order; ancestors need not be given.
class DividedCells {
 public:
  void divide(OctreeKey cell) { levels_[cell.level()].push_back(cell); }
  void divide(std::span<const OctreeKey> cells) {
    for (const OctreeKey cell : cells) divide(cell);
  }
  /// Adds every cell that a tree with these cells divided has divided, and those which 2:1 balance over faces, edges
  /// and corners demands. The result is the smallest balanced tree.
  void close();
  /// The leaves of the closed set.
  Octree tree() const;
  const RawVector<OctreeKey>& level(int l) const { return levels_[l]; }

 private:
  using Level = RawVector<OctreeKey>;
  void leaves_below(OctreeKey top, std::vector<OctreeKey>& leaves) const;

  std::array<Level, OctreeKey::kMaxLevel + 1> levels_;
};

/// The divided cells of a tree: all proper ancestors of its leaves; where leaf i is the first of eight in a cell, only
/// if stays(i).
DividedCells divided_cells(const Octree& tree, const std::function<bool(std::size_t)>& stays = {});

}  // namespace octafront
