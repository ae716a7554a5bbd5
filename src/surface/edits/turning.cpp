#include <octafront/surface_mesh.h>

#include "base/core/elementary.h"
#include "base/geometry/measures.h"
#include "surface/edits/faces_of_input.h"

#include <algorithm>
#include <numbers>

namespace octafront::surface {

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
