#include <octafront/surface_mesh.h>

#include "base/core/parallel.h"
#include "surface/edits/faces_of_input.h"

namespace octafront::surface {

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

std::vector<std::uint32_t> source_triangles(const InputSurface& input, const KnownSurface& original,
                                            const SurfaceMesh& surface, const std::vector<std::uint32_t>& face,
                                            const std::vector<std::uint8_t>& is_inner) {
  std::vector<std::uint32_t> source(surface.triangles.size());
  parallel_for(source.size(), [&](std::size_t t) {
    const auto [a, b, c] = surface.triangles[t];
    source[t] = source_by_walk(input, surface, surface.triangles[t], face, is_inner);
    if (source[t] == kNone)
      source[t] = original.tree().nearest((surface.points[a] + surface.points[b] + surface.points[c]) / 3).triangle;
  });
  return source;
}

}  // namespace octafront::surface
