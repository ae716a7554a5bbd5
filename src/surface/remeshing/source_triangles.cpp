#include "surface/remeshing/source_triangles.h"

#include "geometry/triangle_tree.h"

#include <optional>

namespace octafront::remeshing {

namespace {

/// A walk that ends farther from the centroid than this part of its length has strayed.
constexpr double kStrayed = 0.3;

std::uint32_t source_by_walk(const InputSurface& input, const SurfaceMesh& surface, const Triangle& triangle,
                             const std::vector<std::uint32_t>& face, const std::vector<std::uint8_t>& is_inner) {
  const auto [a, b, c] = triangle;
  const Vec3 center = (surface.points[a] + surface.points[b] + surface.points[c]) / 3;
  for (const VertexIndex v : triangle) {
    if (!is_inner[v]) continue;
    const Vec3 p = surface.points[v], n = input.normal_at(face[v], p);
    const Vec3 along = (center - p) - n * dot(center - p, n);
    const double l = length(center - p);
    SurfacePoint x;
    if (walk(input, {p, face[v]}, normalized(along), n, l, x) != WalkEnd::kArrived) continue;
    if (distance(x.p, center) < kStrayed * l) return x.face;
  }
  return kNone;
}

}  // namespace

std::vector<std::uint32_t> source_triangles(const InputSurface& input, const SurfaceMesh& original,
                                            const SurfaceMesh& surface, const std::vector<std::uint32_t>& face,
                                            const std::vector<std::uint8_t>& is_inner) {
  std::vector<std::uint32_t> source;
  source.reserve(surface.triangles.size());
  std::optional<TriangleTree> tree;
  for (const Triangle& t : surface.triangles) {
    std::uint32_t s = source_by_walk(input, surface, t, face, is_inner);
    if (s == kNone) {
      if (!tree) tree.emplace(original);
      s = tree->nearest((surface.points[t[0]] + surface.points[t[1]] + surface.points[t[2]]) / 3).triangle;
    }
    source.push_back(s);
  }
  return source;
}

}  // namespace octafront::remeshing
