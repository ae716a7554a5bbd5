#include "improve/shape/flat_walls.h"

#include <octafront/surface_mesh.h>

#include "base/core/disjoint_sets.h"
#include "base/geometry/measures.h"

#include <algorithm>

namespace octafront::improve {

namespace {

/// Triangles between whose normals the square of the sine is less lie in one plane: files round, walls do not bend.
constexpr double kFlat = 1e-6;
/// A part of a surface in one plane is a wall if features are this part of its rim, or from so many triangles on.
constexpr double kFramed = 0.9;
constexpr std::size_t kMany = 16;

bool in_one_plane(Vec3 n, Vec3 m) {
  return dot(n, m) > 0 && squared_length(cross(n, m)) <= kFlat * squared_length(n) * squared_length(m);
}

}  // namespace

bool FlatWalls::hold(std::span<const TriangleCorners> around) const {
  std::call_once(is_found_, [this] { find(); });
  return std::any_of(around.begin(), around.end(), [&](const TriangleCorners& t) {
    const std::uint32_t below = tree_.nearest(centroid(t[0], t[1], t[2])).triangle;
    if (below == kNone || is_wall_[below] == 0) return false;
    const auto& [a, b, c] = tree_.corners(below);
    return in_one_plane(double_area_normal(t[0], t[1], t[2]), double_area_normal(a, b, c));
  });
}

void FlatWalls::find() const {
  const EdgeTable table = make_edge_table(input_.points.size(), input_.triangles);
  const auto normal = [&](HalfEdge h) {
    const auto& [a, b, c] = input_.triangles[h / 3];
    return double_area_normal(input_.points[a], input_.points[b], input_.points[c]);
  };
  DisjointSets parts(input_.triangles.size());
  std::vector<std::uint8_t> is_inner(table.size(), 0), is_feature(table.size(), 0);
  for (std::size_t e = 0; e < table.size(); ++e) {
    is_feature[e] = std::binary_search(features_.edges.begin(), features_.edges.end(), table.edges[e]);
    const auto uses = table.uses(e);
    is_inner[e] = uses.size() == 2 && is_feature[e] == 0 && in_one_plane(normal(uses[0]), normal(uses[1]));
    if (is_inner[e] != 0) parts.join(uses[0] / 3, uses[1] / 3);
  }
  std::vector<double> rim(input_.triangles.size(), 0), framed(rim);
  std::vector<std::uint32_t> triangles(input_.triangles.size(), 0);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) ++triangles[parts.find(t)];
  for (std::size_t e = 0; e < table.size(); ++e) {
    if (is_inner[e] != 0) continue;
    const double length = distance(input_.points[table.edges[e][0]], input_.points[table.edges[e][1]]);
    for (const HalfEdge h : table.uses(e)) {
      const std::uint32_t part = parts.find(h / 3);
      rim[part] += length;
      framed[part] += is_feature[e] != 0 ? length : 0;
    }
  }
  is_wall_.resize(triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const std::uint32_t part = parts.find(t);
    is_wall_[t] = triangles[part] >= kMany || framed[part] >= kFramed * rim[part];
  }
}

}  // namespace octafront::improve
