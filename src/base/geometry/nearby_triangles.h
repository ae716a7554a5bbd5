#pragma once

#include "base/geometry/triangle_tree.h"

#include <array>

namespace octafront {

/// The triangles of a tree around one place, laid out for many queries for near points there: a few times faster than
/// to ask the tree each time. Gives what the tree gives, up to the choice among equally near triangles. One for each
/// worker; the tree must outlive its use.
class NearbyTriangles {
 public:
  /// Collects what the cube about `center` with half-side `reach` meets. Where that is too much to be worth it, queries
  /// go to the tree.
  void gather(const TriangleTree& tree, Vec3 center, double reach);

  /// The nearest point with squared distance below `limit_squared`, as TriangleTree::nearest(). Requires gather().
  TriangleTree::Nearest nearest(Vec3 p, double limit_squared) const;

 private:
  static constexpr int kMost = 192;

  bool covers(Vec3 p, double limit_squared) const;

  const TriangleTree* tree_ = nullptr;
  Box3 reached_;
  int size_ = 0;  ///< 0 also where there were too many
  bool complete_ = false;
  alignas(64) std::array<std::array<double, kMost>, 3> middle_, half_;  ///< boxes, [axis][triangle]
  std::array<const TriangleCorners*, kMost> corners_;
  std::array<std::uint32_t, kMost> triangle_;
  alignas(64) mutable std::array<double, kMost> squared_distance_;  ///< of a query from the boxes, to rounding
};

}  // namespace octafront
