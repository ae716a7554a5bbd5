#pragma once

#include <octafront/options.h>
#include <octafront/surface_mesh.h>

#include "base/geometry/triangle_tree.h"
#include "sizing/surface_samples.h"

#include <optional>
#include <vector>

namespace octafront {

/// Sizes given at points, at any place of a surface: linear on its triangles if each of its vertices has a point,
/// otherwise that of the nearest point.
class PointSizes {
 public:
  /// Requires points. Vertices and points are one if they are nearer than a millionth of the diagonal.
  PointSizes(const SurfaceMesh& surface, std::vector<PointSize> points);
  double at(const PlaceOnSurface& place) const;
  bool is_per_vertex() const { return !of_vertex_.empty(); }

 private:
  std::uint32_t nearest(Vec3 p, double limit_squared) const { return tree_->nearest(p, limit_squared).triangle; }

  const SurfaceMesh& surface_;
  std::vector<PointSize> points_;
  std::optional<TriangleTree> tree_;  ///< over the points, as triangles without extent
  std::vector<double> of_vertex_;     ///< empty: the nearest point speaks
};

}  // namespace octafront
