#pragma once

// A box divided into convex cells that share their faces exactly: by planes, or as the Voronoi cells of points. Built
// by cutting, so that every vertex, edge and face is made once, whatever the rounding.

#include <octafront/surface_mesh.h>

#include <cstdint>
#include <map>
#include <vector>

namespace octafront::testing {

class ConvexCells {
 public:
  /// One cell, the box from the origin to `size`. Patches 0 to 5: x low, x high, y low, ...; walls inside are patch 6.
  explicit ConvexCells(Vec3 size);

  /// Cuts every cell by the plane n . x = c.
  void cut(Vec3 n, double c);
  /// Inserts a Voronoi cell; the first site owns the whole box. Requires sites inside the box, in general position.
  void insert_site(Vec3 site);

  std::uint32_t count() const { return cells_; }
  /// The faces as fans of triangles; region = cell.
  SurfaceMesh complex() const;

 private:
  struct Face {
    std::vector<std::uint32_t> corners;  ///< counter-clockwise seen from the front
    Sides cells;
    std::uint32_t patch;
  };
  /// A number per vertex that is linear in each cell; the sign says on which side of the cut it lies.
  using Heights = std::vector<double>;

  void split(const Heights& height, bool merge);
  /// Those amid an edge, where cells met that are one now.
  void drop_loose_vertices();
  std::uint32_t crossing(std::uint32_t a, std::uint32_t b, const Heights& height);

  std::vector<Vec3> points_;
  std::vector<Vec3> site_of_;  ///< per vertex: one of the sites it is nearest to
  std::vector<Vec3> sites_;
  std::vector<Face> faces_;
  std::uint32_t cells_ = 1;
  std::map<Edge, std::uint32_t> crossing_;  ///< where edges meet the cut under way
};

}  // namespace octafront::testing
