#include "surface/lines/least_sizes.h"

#include <octafront/surface_mesh.h>

#include "base/core/elementary.h"
#include "base/geometry/measures.h"
#include "base/mesh/complex.h"

#include <algorithm>
#include <cmath>

namespace octafront::surface {

namespace {

/// So many elements along a region keep its shape.
constexpr double kAlongSmallRegion = 3;
/// An icosahedron has edges of this part of the third root of the volume of its ball: regions as small keep that.
constexpr double kOfSmallRegion = 0.65;

}  // namespace

LeastSizes::LeastSizes(const KnownSurface& known, double least) : known_(known), least_(least) {
  if (!(least > 0) || known.mesh().sides.empty()) return;
  for (const double volume : volumes_of_regions(known.mesh()))
    of_region_.push_back(std::min(least, elementary::cbrt(std::abs(volume)) / kAlongSmallRegion));
  if (std::ranges::all_of(of_region_, [&](double of) { return of == least; })) of_region_.clear();
}

double LeastSizes::at(Vec3 p) const {
  if (of_region_.empty()) return least_;
  double least = least_;
  for (const std::uint32_t region : known_.mesh().sides_of(known_.tree().nearest(p).triangle))
    if (region != kNone) least = std::min(least, of_region_[region]);
  return least;
}

std::vector<PointSize> LeastSizes::small_regions(const SizeField& sizes) const {
  std::vector<PointSize> places;
  if (of_region_.empty()) return places;
  const SurfaceMesh& surface = known_.mesh();
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& [a, b, c] = surface.triangles[t];
    const Vec3 p = centroid(surface.points[a], surface.points[b], surface.points[c]);
    for (const std::uint32_t region : surface.sides_of(t)) {
      if (region == kNone || of_region_[region] == least_) continue;
      const double size = kOfSmallRegion * kAlongSmallRegion * of_region_[region];
      if (size < sizes.at(p)) places.push_back({p, size});
    }
  }
  return places;
}

}  // namespace octafront::surface
