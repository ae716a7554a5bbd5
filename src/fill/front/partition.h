#pragma once

#include "fill/front/front_state.h"

#include <cstdint>
#include <vector>

namespace octafront {

/// A box of space whose faces are advanced by themselves while other blocks do the same: the unit of parallel work.
struct FrontBlock {
  struct Member {
    std::uint32_t face : 31;  ///< number in the FrontState
    std::uint32_t owned : 1;  ///< its centroid lies in this block, and in no other
  };
  static constexpr std::uint64_t kMostFaces = std::uint64_t{1} << 31;  ///< that Member::face tells apart
  Box3 territory;                                                      ///< open; infinite where no other block lies
  RawVector<Member> members;   ///< every face that reaches into the territory, in ascending order
  std::size_t queued = 0;      ///< owned faces of the queue; where it is 0, nothing happens
  bool is_of_regions = false;  ///< all of some regions, nothing of which is in other blocks: worked off to its end

  /// Everything in one block. Throws MeshingError if the front has more than kMostFaces.
  static FrontBlock whole(const FrontState& front);
};

struct PartitionRule {
  std::size_t queued_faces = 2000;             ///< a block with more of them is divided
  double quantile = 0.5;                       ///< where it is divided: share of its faces on the lower side
  std::size_t faces = FrontBlock::kMostFaces;  ///< nor may it have more than this: each costs its place in an index
};

/// Regions are apart: several small ones make a block, large ones are divided by themselves. Divides space by planes
/// across the longer extents of the queue, or of all faces where few of them are queued, until no block has too many,
/// or a plane would cut what too many of the queue reach. Blocks therefore follow the sizes of the elements, and hold
/// alike amounts of work. The result depends on the front and the rule alone. These are not the cells of base/shared: a
/// face is a member of each block that it reaches into, and whether a plane cuts too many is asked of the reach of
/// faces, not of points.
std::vector<FrontBlock> partition_front(const FrontState& front, const PartitionRule& rule);

}  // namespace octafront
