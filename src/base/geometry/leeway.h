#pragma once

#include <octafront/surface_mesh.h>

#include "base/geometry/triangle_tree.h"

#include <span>

namespace octafront {

/// How far a surface that is made anew may be moved at a place: by what was allowed, but no more than a part of the
/// way through the body there. Whatever a tolerance says, a plate keeps its thickness. Walls of a complex are as near
/// to each other as one likes, and may move as far as was allowed. Where a triangle of the input has a bound of its own
/// no move is longer than that. Const and thread-safe.
class Leeway {
 public:
  /// Of the way through the body. If both sides moved outward everywhere that would be a fifth of its volume; few
  /// places move, and what they come to in all is looked at in the end.
  static constexpr double kPart = 0.25;

  /// `tree`: over the triangles of the input `surface`; `bound`: one for each, or empty. Both must outlive this.
  Leeway(const SurfaceMesh& surface, const TriangleTree& tree, std::span<const double> bound = {})
      : tree_(tree), bound_(bound), is_complex_(!surface.sides.empty()) {}

  /// `allowed`, or kPart of the way through the body where the input is nearest to p, or the bound there, if less. At
  /// an edge or a corner the shortest way counts. Input units.
  double at(Vec3 p, double allowed) const;

 private:
  double way_through(Vec3 home, Vec3 from, Vec3 inward, double most) const;

  const TriangleTree& tree_;
  std::span<const double> bound_;
  bool is_complex_;
};

}  // namespace octafront
