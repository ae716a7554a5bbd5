#include "base/geometry/predicates.h"
#include "base/geometry/self_intersection.h"
#include "surface/edits/working_mesh.h"

#include <algorithm>

namespace octafront::surface {

std::vector<std::array<std::uint32_t, 2>> find_crossings(const SurfaceMesh& surface) {
  std::vector<std::array<std::uint32_t, 2>> pairs;
  std::vector<std::uint32_t> proper;
  std::vector<Triangle> triangles;
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    const auto [a, b, c] = surface.triangles[t];
    if (collinear(surface.points[a], surface.points[b], surface.points[c])) {
      pairs.push_back({t, t});
    } else {
      proper.push_back(t);
      triangles.push_back(surface.triangles[t]);
    }
  }
  for (const auto& [s, t] : self_intersections(surface.points, triangles)) pairs.push_back({proper[s], proper[t]});
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace octafront::surface
