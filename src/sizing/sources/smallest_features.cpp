#include <octafront/smallest_features.h>

#include "base/core/parallel.h"
#include "base/core/thread_limit.h"
#include "base/geometry/measures.h"
#include "base/mesh/known_surface.h"
#include "sizing/sources/gaps.h"
#include "sizing/sources/sources.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace octafront {

namespace {

constexpr double kPlacesOfSurface = 20'000;
/// Triangles that are looked at; of more every second one, or third, and so on.
constexpr std::size_t kMostLookedAt = 500'000;
/// What is thinner than this part of the model is not told apart from it.
constexpr double kThinnestPart = 1e-7;

struct MeasuredPlace {
  PlaceOnSurface place;
  double area, width = GapFinder::kOpen;
};

/// Middles of the `rows`^2 triangles that one is divided into.
void add_places(const SurfaceMesh& surface, std::uint32_t face, int rows, double area,
                std::vector<MeasuredPlace>& places) {
  const auto& [i, j, k] = surface.triangles[face];
  const Vec3 a = surface.points[i], u = surface.points[j] - a, v = surface.points[k] - a;
  const Vec3 n = unit_normal(a, surface.points[j], surface.points[k]);
  const auto add = [&](double s, double t) {
    places.push_back({{a + (s / rows) * u + (t / rows) * v, n, face}, area / (rows * rows)});
  };
  for (int s = 0; s < rows; ++s)
    for (int t = 0; s + t < rows; ++t) {
      add(s + 1.0 / 3, t + 1.0 / 3);
      if (s + t + 1 < rows) add(s + 2.0 / 3, t + 2.0 / 3);
    }
}

std::vector<MeasuredPlace> places_on(const SurfaceMesh& surface) {
  const auto area_of = [&](std::size_t f) { return triangle_area(surface.points, surface.triangles[f]); };
  double all = 0;
  for (std::size_t f = 0; f < surface.triangles.size(); ++f) all += area_of(f);
  const std::size_t stride = surface.triangles.size() / kMostLookedAt + 1;
  std::vector<MeasuredPlace> places;
  for (std::size_t f = 0; f < surface.triangles.size(); f += stride) {
    const double area = area_of(f);
    const double share = all > 0 ? kPlacesOfSurface * area / all : 0;
    add_places(surface, static_cast<std::uint32_t>(f), std::max(1, static_cast<int>(std::lround(std::sqrt(share)))),
               area, places);
  }
  return places;
}

/// Over which walls so large a part of the area is.
double width_of_part(const std::vector<MeasuredPlace>& by_width, double part) {
  double all = 0, passed = 0;
  for (const MeasuredPlace& p : by_width) all += p.area;
  for (const MeasuredPlace& p : by_width)
    if (passed += p.area; passed >= part * all) return p.width;
  return SmallestFeatures::kNone;
}

void measure_walls(const KnownSurface& known, SmallestFeatures& found) {
  const double diagonal = bounding_box(known.mesh().points).diagonal();
  const GapFinder walls(known, kThinnestPart * diagonal, diagonal, Measured::kWalls);
  std::vector<MeasuredPlace> places = places_on(known.mesh());
  parallel_for(places.size(), [&](std::size_t i) { places[i].width = walls.measure(places[i].place); });
  std::ranges::stable_sort(places, [](const auto& a, const auto& b) { return a.width < b.width; });
  if (places.empty()) return;
  found.thickness = places.front().width, found.thinnest_at = places.front().place.p;
  found.thin_tenth = width_of_part(places, 0.1), found.thin_half = width_of_part(places, 0.5);
}

void measure_edges(const KnownSurface& known, SmallestFeatures& found) {
  for (const FeatureCurve& curve : feature_curves(known.mesh(), known.features())) {
    if (!(curve.length < found.shortest_edge)) continue;
    found.shortest_edge = curve.length;
    found.shortest_at = known.mesh().points[curve.vertices[curve.vertices.size() / 2]];
  }
}

}  // namespace

SmallestFeatures smallest_features(const SurfaceMesh& surface, double feature_angle, const RunContext& context) {
  const ThreadLimit limit(context.threads);
  const KnownSurface known(surface, feature_angle);
  SmallestFeatures found;
  if (surface.triangles.empty()) return found;
  measure_walls(known, found);
  measure_edges(known, found);
  return found;
}

}  // namespace octafront
