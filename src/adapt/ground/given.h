#pragma once

// A surface that the walls of a mesh are to lie on, given beside it: triangles as they are, or the true geometry that
// they stand for.

#include <octafront/surface_mesh.h>

#include "base/geometry/triangle_tree.h"
#include "base/geometry/true_geometry.h"
#include "base/mesh/edge_table.h"
#include "base/mesh/features.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace octafront::adapt {

/// Const and safe on any number of threads.
class GivenSurface {
 public:
  /// Vertices at one place must be one. `geometry`, which may be null and must outlive this, has the patches of the
  /// surface. Walls farther than `reach` do not belong to it, unless they are of elements larger than that.
  GivenSurface(SurfaceMesh surface, const TrueGeometry* geometry, double feature_angle, double reach);

  double reach() const { return reach_; }
  std::size_t size() const { return surface_.triangles.size(); }
  const TriangleCorners& corners(std::uint32_t triangle) const { return tree_.corners(triangle); }

  struct Place {
    Vec3 at;
    Vec3 normal;  ///< of its triangle, of any length; turned as the one asked for
  };
  /// The nearest place that is not turned away from `normal`: outward where both are of outer walls, else either way.
  std::optional<Place> on_surface(Vec3 p, Vec3 normal, bool outer, double reach) const;
  /// The nearest place of the feature lines, where they run about along `direction`.
  std::optional<Vec3> on_line(Vec3 p, Vec3 direction, double reach) const;
  /// The nearest point where feature lines end, meet or bend.
  std::optional<Vec3> corner(Vec3 p, double reach) const;

  /// The place over a point of a triangle.
  Vec3 over(std::uint32_t triangle, Vec3 p) const;

 private:
  void find_outside();
  /// The cosine times the lengths of both; < 0 where they are turned away from each other.
  double agreement(std::uint32_t triangle, Vec3 own, Vec3 normal, bool outer) const;

  SurfaceMesh surface_;
  const TrueGeometry* geometry_;
  double reach_;
  TriangleTree tree_;
  Features lines_;
  TriangleTree line_tree_, corner_tree_;                ///< triangles with corners that are one
  std::vector<std::vector<std::uint32_t>> patches_at_;  ///< per feature edge: the patches that meet there, ascending
  std::vector<std::int8_t> outside_;  ///< per triangle: 1 in front, -1 behind, 0 on no side or not known
};

}  // namespace octafront::adapt
