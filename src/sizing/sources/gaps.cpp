#include "sizing/sources/gaps.h"

#include <octafront/surface_mesh.h>

#include "base/core/elementary.h"
#include "base/core/parallel.h"
#include "base/geometry/measures.h"
#include "sizing/field/thin_walls.h"

#include <algorithm>
#include <cmath>

namespace octafront {

namespace {

/// Answers are shared within cells of this part of the reach.
constexpr double kSharedPart = 0.25;
constexpr double kUnknown = -1;

/// Which of the six sides of a cube the normal points to: sheets back to back share no answer.
std::uint64_t side_of_cube(Vec3 n) {
  int axis = 0;
  for (int a = 1; a < 3; ++a) {
    if (std::abs(n[a]) > std::abs(n[axis])) axis = a;
  }
  return static_cast<std::uint64_t>(2 * axis + (n[axis] > 0));
}

}  // namespace

GapFinder::GapFinder(const KnownSurface& known, double nearest, double reach, Measured what)
    : surface_(known.mesh()),
      tree_(known.tree()),
      what_(what),
      root_(RootCube::around(bounding_box(known.mesh().points), 0)),
      nearest_(nearest),
      reach_(reach) {
  const SurfaceMesh& surface = known.mesh();
  either_way_ = !surface.sides.empty();
  normal_.resize(surface.triangles.size());
  inside_.resize(surface.triangles.size());
  parallel_for(normal_.size(), [&](std::size_t f) {
    const auto& [a, b, c] = surface.triangles[f];
    normal_[f] = unit_normal(surface.points[a], surface.points[b], surface.points[c]);
  });
  const double shared = std::max(nearest, kSharedPart * reach);
  level_ = std::clamp(static_cast<int>(std::ceil(elementary::log2(root_.side / shared))), 0, OctreeKey::kMaxLevel - 2);
  measure_middles(surface);
}

std::uint64_t GapFinder::neighbourhood(const PlaceOnSurface& place) const {
  // The marker bit ends a key of this level, with at least three zeros behind it: room for the side.
  return root_.cell(place.p).ancestor(level_).id() | side_of_cube(place.n);
}

void GapFinder::measure_middles(const SurfaceMesh& surface) {
  const auto middle = [&](std::size_t f) {
    const auto& [a, b, c] = surface.triangles[f];
    return PlaceOnSurface{centroid(surface.points[a], surface.points[b], surface.points[c]), normal_[f],
                          static_cast<std::uint32_t>(f)};
  };
  RawVector<std::uint64_t> around(surface.triangles.size());
  parallel_for(around.size(), [&](std::size_t f) { around[f] = neighbourhood(middle(f)); });
  std::vector<std::uint32_t> first;
  for (std::size_t f = 0; f < around.size(); ++f) {
    if (f > 0 && around[f] == around[f - 1]) continue;
    double& width = known_.find_or_add(around[f], kUnknown);
    if (width != kUnknown) continue;
    width = kOpen;
    first.push_back(static_cast<std::uint32_t>(f));
  }
  std::vector<double> widths(first.size());
  parallel_for(first.size(), [&](std::size_t i) { widths[i] = measure(middle(first[i])); });
  for (std::size_t i = 0; i < first.size(); ++i) *known_.find(around[first[i]]) = widths[i];
}

double GapFinder::width(const PlaceOnSurface& place) {
  const std::uint64_t here = neighbourhood(place);
  if (const double* shared = known_.find(here)) return *shared;
  std::unique_ptr<Widths>& inside = inside_[place.face];
  if (!inside) inside = std::make_unique<Widths>();
  double& width = inside->find_or_add(here, kUnknown);
  if (width == kUnknown) width = measure(place);
  return width;
}

double GapFinder::measure(const PlaceOnSurface& place) const {
  const auto [front, behind] = surface_.sides_of(place.face);
  double width = kOpen;
  if (what_ == Measured::kWallsAndGaps || front != kNone) width = distance_along(place, place.n);
  if (what_ == Measured::kWallsAndGaps || behind != kNone) width = std::min(width, distance_along(place, -place.n));
  return width;
}

double GapFinder::distance_along(const PlaceOnSurface& place, Vec3 direction) const {
  // The first part of the way is left out: the place's own triangle and its neighbours lie there.
  const double skipped = 0.1 * nearest_;
  const TriangleTree::RayHit hit = tree_.first_hit(place.p + skipped * direction, direction, reach_ - skipped);
  if (hit.triangle == kNone) return kOpen;
  const Vec3 n = normal_[hit.triangle];
  if (!faces(n, place.n) && !(either_way_ && faces(-n, place.n))) return kOpen;
  return skipped + hit.t;
}

}  // namespace octafront
