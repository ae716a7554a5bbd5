#pragma once

#include <octafront/ids.h>
#include <octafront/vec.h>

#include "base/core/flat_map.h"
#include "fill/front/box_culling.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace octafront {

using FaceIndex = std::uint32_t;

/// What may touch a new tetrahedron: faces whose boxes overlap `box`, come nearer to `center` than `radius`, and are
/// not entirely behind the plane normal . x = offset. Each of the three is a bound of its own; all are culled
/// conservatively.
struct SearchRegion {
  Box3 box;
  Vec3 center;
  double radius = 0;
  Vec3 normal;  ///< unit length
  double offset = 0;
  std::uint32_t of = kNone;  ///< the region of a complex whose faces are asked for; kNone: any
};

/// Where the active front is: finds the faces whose boxes reach into a region.
///
/// A face lives in one cell of one level of a hierarchy of grids: the level whose cells are just large enough for it
/// (cell >= 1.43 times its largest extent), the cell that holds the middle of its box. Sizes that differ by any factor
/// therefore cost the same. A cell keeps its faces in blocks of 16, coordinate by coordinate, as single-precision boxes
/// relative to the brick (4 x 4 x 4 cells) they lie in; a brick has one bit for each of its
/// cells, so empty cells cost nothing. Faces leave when they are consumed: what is searched is only the active front.
/// The order of answers depends on the order of insertions and removals alone.
class FrontIndex {
 public:
  struct Found {
    FaceIndex face;
    Triangle corners;
  };

  /// `domain` bounds every face that will ever be inserted; `finest_cell` is the cell of level 0 (raised where the
  /// domain has more than 2^20 of them along an axis).
  FrontIndex(const Box3& domain, double finest_cell);

  /// Requires that `face` is not in the index. A face of no region is found by all.
  void insert(FaceIndex face, const Triangle& corners, const Box3& box, std::uint32_t region = kNone);
  void remove(FaceIndex face);
  /// Appends the faces that reach into the region to `out`; some that just miss it may be among them.
  void find(const SearchRegion& region, std::vector<Found>& out) const;
  bool contains(FaceIndex face) const { return face < place_.size() && place_[face] != kNone; }
  std::size_t size() const;

  /// What is wrong around a face, or anywhere.
  std::optional<std::string> first_inconsistency(FaceIndex face) const;
  std::optional<std::string> first_inconsistency() const;

 private:
  static constexpr int kWidth = BoxBlock::kWidth;  // faces in a block
  static constexpr int kLevels = 22;
  static constexpr std::size_t kExpectedBricks = 512;
  using Cell = std::array<int, 3>;
  struct Block {
    BoxBlock boxes;
    std::uint32_t corner[3][kWidth];
    FaceIndex face[kWidth];
    std::uint32_t region[kWidth];
    std::uint32_t next, cell, count;  // cell: brick * 64 + cell of the brick
  };
  struct Brick {
    std::uint64_t occupied = 0;  ///< cells with faces of this level
    std::uint64_t below = 0;     ///< cells that are bricks two levels down with anything in or below them
    Vec3 origin;
    Cell at{};
    int level = 0;
    std::array<std::uint32_t, 64> head;
  };
  std::uint32_t brick_at(int level, const Cell& brick) const;
  std::uint32_t make_brick(int level, const Cell& brick);
  std::uint32_t new_block(std::uint32_t cell, std::uint32_t next);
  /// Tells the bricks above that this one is no longer empty, or is empty again.
  void mark_above(std::uint32_t brick, bool empty);
  /// The cells of a level that a face may have its middle in if it reaches into `box`.
  std::array<Cell, 2> cells_in_reach(int level, const Box3& box) const;
  void find_in_level(int level, bool descend, const SearchRegion& region, std::vector<Found>& out) const;
  void find_in_brick(std::uint32_t brick, const std::array<Cell, 2>& range, bool descend, const SearchRegion& region,
                     std::vector<Found>& out) const;
  /// Counts the faces in a cell whose blocks are in order; says what is wrong with them otherwise.
  std::optional<std::string> check_cell(std::uint32_t brick, std::uint32_t cell, std::size_t& faces) const;
  void find_in_cells(const Brick& brick, std::uint64_t cells, const SearchRegion& region,
                     std::vector<Found>& out) const;

  Vec3 origin_;
  std::array<double, kLevels> cell_{}, per_cell_{};
  std::array<std::uint32_t, kLevels> faces_at_level_{};
  std::uint32_t levels_ = 0;  ///< bits of the levels with faces
  std::vector<Block> blocks_;
  std::uint32_t free_block_ = kNone;
  std::vector<Brick> bricks_;
  FlatMap<std::uint64_t, std::uint32_t> brick_of_key_{kExpectedBricks};
  std::vector<std::uint32_t> place_;  // per face: block * 16 + slot
};

}  // namespace octafront
