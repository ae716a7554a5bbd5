#include "surface/edits/faces_of_input.h"

#include <octafront/surface_mesh.h>

#include "base/core/elementary.h"
#include "base/core/parallel.h"
#include "base/geometry/measures.h"

#include <algorithm>
#include <numbers>

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

namespace {

/// Turning falls as the size; noise does not, so a step is neither too timid nor too bold.
constexpr double kSafety = 0.85, kLeastTurnFactor = 0.5, kMostTurnFactor = 0.85;

double cosine_to(const InputSurface& input, Vec3 normal, std::uint32_t face, Vec3 p) {
  return std::max(dot(normal, input.normal_at(face, p)), dot(normal, input.face_normal[face]));
}

}  // namespace

std::vector<PointSize> turned_places(double degrees, const SurfaceMesh& made, const InputSurface& input,
                                     const SizeField& sizes, const std::vector<std::uint32_t>& face,
                                     const std::vector<std::uint8_t>& is_inner,
                                     const std::vector<std::uint32_t>& source) {
  const double limit = degrees * std::numbers::pi / 180, least = elementary::cos(limit);
  std::vector<PointSize> places;
  for (std::size_t t = 0; t < made.triangles.size(); ++t) {
    const auto [i, j, k] = made.triangles[t];
    const Vec3 a = made.points[i], b = made.points[j], c = made.points[k], middle = centroid(a, b, c);
    const Vec3 normal = unit_normal(a, b, c);
    double cosine = cosine_to(input, normal, source[t], middle);
    for (const VertexIndex v : made.triangles[t]) {
      if (is_inner[v]) cosine = std::min(cosine, cosine_to(input, normal, face[v], made.points[v]));
    }
    if (cosine >= least) continue;
    const double turn = elementary::acos(std::clamp(cosine, -1.0, 1.0));
    places.push_back(
        {middle, sizes.at(middle) * std::clamp(kSafety * limit / turn, kLeastTurnFactor, kMostTurnFactor)});
  }
  return places;
}

}  // namespace octafront::surface
