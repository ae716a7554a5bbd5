#pragma once

#include <octafront/vec.h>

#include "base/core/morton.h"
#include "base/core/parallel_arrays.h"

#include <array>
#include <bit>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace octafront {

/// A cell of the octree as one integer: its level and its place on the Z-order (Morton) curve.
///
///   bit   63 ... 61   60 ...................................................... 0
///          0  0  0    ddd ddd ddd ... ddd   1   000 000 ... 000
///                     level digits, root    |   three zeros for each level
///                     first, zyx each       |   that the cell is above kMaxLevel
///                                        marker
///
/// Digit k names the child taken on the way from level k - 1 to level k: bit 0 of it is the half along x, bit 1 along
/// y, bit 2 along z. The root has no digits: its id is the marker alone, 1 << 60. Id 0 is no cell.
///
/// Order. Ids are unique over all levels. Cells of one level sort along the curve; the cells inside a cell have ids in
/// [range_min(), range_max()], and its own id lies in the middle of them: children 0-3 before it, 4-7 behind. Leaves
/// that cover the root cube without overlap, sorted by id, are in the order of the curve.
///
/// Coordinates. The root cube has kSide units along each axis; a cell of level l has side kSide >> l. A cell is the
/// half-open box [x, x + side) x [y, y + side) x [z, z + side).
///
/// (The scheme of a level marker behind a curve position is that of S2 cell ids; the curve here is plain Morton order.)
class OctreeKey {
 public:
  static constexpr int kMaxLevel = 20;
  static constexpr std::uint32_t kSide = 1u << kMaxLevel;

  constexpr OctreeKey() = default;
  static constexpr OctreeKey root() { return OctreeKey(std::uint64_t{1} << (3 * kMaxLevel)); }
  static constexpr OctreeKey from_id(std::uint64_t id) { return OctreeKey(id); }
  /// The cell of `level` that contains the unit (x, y, z). REQUIRES: x, y, z < kSide, 0 <= level <= kMaxLevel.
  static constexpr OctreeKey containing(std::uint32_t x, std::uint32_t y, std::uint32_t z, int level = kMaxLevel) {
    const std::uint64_t position = morton_code(x, y, z) << 1 | 1;
    const std::uint64_t marker = marker_of(level);
    return OctreeKey((position & (0 - marker)) | marker);
  }

  constexpr std::uint64_t id() const { return id_; }
  /// True if the id is that of a cell.
  constexpr bool is_valid() const {
    return id_ != 0 && id_ < std::uint64_t{2} << (3 * kMaxLevel) && std::countr_zero(id_) % 3 == 0;
  }
  constexpr int level() const { return kMaxLevel - std::countr_zero(id_) / 3; }
  /// Side in units: kSide >> level().
  constexpr std::uint32_t side() const { return kSide >> level(); }
  /// Lower corner in units.
  constexpr std::array<std::uint32_t, 3> corner() const {
    const std::uint64_t digits = (id_ - marker()) >> 1;
    return {gather_bits(digits), gather_bits(digits >> 1), gather_bits(digits >> 2)};
  }

  /// The cell one level up. REQUIRES: level() > 0.
  constexpr OctreeKey parent() const {
    const std::uint64_t up = marker() << 3;
    return OctreeKey((id_ & (0 - up)) | up);
  }
  /// The cell of `level` that contains this one. REQUIRES: level <= this->level().
  constexpr OctreeKey ancestor(int level) const {
    const std::uint64_t up = marker_of(level);
    return OctreeKey((id_ & (0 - up)) | up);
  }
  /// Child i, with the halves x = i & 1, y = i >> 1 & 1, z = i >> 2. REQUIRES: level() < kMaxLevel.
  constexpr OctreeKey child(int i) const {
    const std::uint64_t m = marker();
    return OctreeKey(id_ - m + (2 * static_cast<std::uint64_t>(i) + 1) * (m >> 3));
  }
  /// Which child of its parent it is. REQUIRES: level() > 0.
  constexpr int child_number() const { return static_cast<int>(id_ / (marker() << 1) & 7); }

  /// Least and greatest id of the cells inside, itself included.
  constexpr std::uint64_t range_min() const { return id_ - (marker() - 1); }
  constexpr std::uint64_t range_max() const { return id_ + (marker() - 1); }
  /// True if `other` is this cell or lies inside it.
  constexpr bool contains(OctreeKey other) const { return range_min() <= other.id_ && other.id_ <= range_max(); }

  /// The cell of the same level `dx, dy, dz` cells away; an invalid key (id 0) outside the root cube. REQUIRES: each is
  /// -1, 0 or 1.
  constexpr OctreeKey neighbour(int dx, int dy, int dz) const {
    // Digits are added where they lie: the bits of the other axes are filled, so that carries run over them.
    std::uint64_t beside = marker();
    const std::array<int, 3> steps{dx, dy, dz};
    for (int axis = 0; axis < 3; ++axis) {
      const std::uint64_t bits = kBitsOfX << axis, mine = id_ & ~marker() & bits, one = marker() << 1 << axis;
      const std::uint64_t above = ((mine | ~bits) + one) & bits, below = (mine - one) & bits;
      if (steps[axis] > 0 && above <= mine) return OctreeKey();
      if (steps[axis] < 0 && below >= mine) return OctreeKey();
      beside |= steps[axis] == 0 ? mine : steps[axis] > 0 ? above : below;
    }
    return OctreeKey(beside);
  }

  friend constexpr bool operator==(OctreeKey, OctreeKey) = default;
  friend constexpr auto operator<=>(OctreeKey, OctreeKey) = default;

 private:
  /// Of the digits of all levels.
  static constexpr std::uint64_t kBitsOfX = 0x492492492492492;  // 1, 4 ... 3 kMaxLevel - 2

  constexpr explicit OctreeKey(std::uint64_t id) : id_(id) {}
  constexpr std::uint64_t marker() const { return id_ & (0 - id_); }
  static constexpr std::uint64_t marker_of(int level) { return std::uint64_t{1} << (3 * (kMaxLevel - level)); }

  std::uint64_t id_ = 0;
};

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
