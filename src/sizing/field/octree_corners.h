#pragma once

#include "base/core/groups.h"
#include "sizing/field/octree.h"

#include <array>
#include <cstdint>
#include <span>

namespace octafront {

/// The corners of the leaves of a balanced octree, each once.
///
/// A corner that lies inside an edge or a face of a larger leaf hangs: for the field to be continuous its value is the
/// mean of the two ends of that edge, or of the four corners of that face, which may hang in turn. Written out, the
/// value of every corner is a convex combination of values of free corners.
struct OctreeCorners {
  struct Share {
    std::uint32_t corner;  ///< a free corner
    double weight;
  };
  RawVector<std::array<std::uint32_t, 8>> of_leaf;   ///< per leaf; number i has the halves of child i
  RawVector<std::array<std::uint32_t, 3>> position;  ///< per corner, in units, 0 ... kSide
  Groups<> leaves;                                   ///< of each corner, as 8 * leaf + which of its corners
  RawVector<std::uint32_t> first_share;              ///< per corner and one more; a free corner has none
  RawVector<Share> shares;

  std::size_t size() const { return position.size(); }
  bool hangs(std::uint32_t corner) const { return first_share[corner] != first_share[corner + 1]; }
  std::span<const Share> shares_of(std::uint32_t corner) const {
    return {shares.data() + first_share[corner], shares.data() + first_share[corner + 1]};
  }
  /// Per leaf what its corners have.
  RawVector<std::array<double, 8>> at_leaves(std::span<const double> of_corner) const;
};

/// REQUIRES: tree.is_balanced(). Corners are numbered as the leaves meet them. O(leaves log leaves).
OctreeCorners octree_corners(const Octree& tree);

}  // namespace octafront
