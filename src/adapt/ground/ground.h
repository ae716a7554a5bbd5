#pragma once

// adapt/ground: what the walls of a mesh stand for when it comes: the smooth surface and the smooth lines through them.
// Tells where new vertices of walls and lines belong, and how far new triangles are from it.

#include <octafront/surface_mesh.h>

#include "base/core/flat_map.h"
#include "base/geometry/triangle_tree.h"
#include "base/mesh/edge_table.h"
#include "base/mesh/features.h"
#include "improve/curved/smooth_surface.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace octafront::adapt {

/// The walls of a mesh as triangles, and the lines where they end, meet or bend.
struct Walls {
  SurfaceMesh surface;              ///< `patch`: the number of the part; turned the same way as far as that goes
  std::vector<std::uint8_t> outer;  ///< per triangle: nothing lies in front of it
  EdgeTable edges;                  ///< of the triangles
  Features lines;
  std::vector<std::uint32_t> path;  ///< per line edge: the line it belongs to
};

/// Const and safe on any number of threads.
class Ground {
 public:
  explicit Ground(Walls walls);

  /// The place of the smooth surface of a part that belongs to p, if that part is within reach of p and not turned away
  /// from `normal`: for outer walls outward, of others either way.
  std::optional<Vec3> on_surface(Vec3 p, std::uint32_t part, bool outer, Vec3 normal, double reach) const;
  /// The place of the smooth line that belongs to p, if it is within reach.
  std::optional<Vec3> on_line(Vec3 p, std::uint32_t path, double reach) const;

  /// How triangles of a part lie to it, at the worst of the places looked at: middles of triangles and of edges.
  struct Truth {
    double distance = 0;  ///< input units; infinite where the part is not within reach
    double cosine = 1;    ///< of the angle between a triangle and the surface at its middle
  };
  Truth truth_of(const TriangleCorners& t, std::uint32_t part, bool outer, double reach) const;

  /// The smooth surface of a triangle of the walls, as triangles whose middles, and those of their edges, are within
  /// `tolerance` of it, or which are a thousandth of the whole.
  std::vector<TriangleCorners> divided(std::uint32_t triangle, double tolerance) const;

  const Walls& walls() const { return walls_; }
  const TriangleTree& tree() const { return tree_; }

 private:
  std::optional<curved::Foot> foot(Vec3 p, std::uint32_t part, bool outer, Vec3 normal, double reach) const;

  /// The smooth surface over a place of a triangle, by its barycentric weights.
  Vec3 smooth_at(std::uint32_t triangle, Vec3 weights) const;

  Walls walls_;
  FlatMap<Edge, std::uint32_t> line_at_;  ///< per sorted edge of a line its number
  TriangleTree tree_;
  curved::SmoothSurface smooth_;
};

}  // namespace octafront::adapt
