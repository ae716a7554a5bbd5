#include "surface/remeshing/far_places.h"

#include "surface/lines/line_sizes.h"
#include "surface/lines/seams.h"
#include "surface/remeshing/outcome.h"

#include <algorithm>
#include <cmath>

namespace octafront::surface {

namespace {

/// Sizes are made smaller to come to this part of the bound, to no less than this part of themselves at once.
constexpr double kAim = 0.75, kLeastPart = 0.4;

}  // namespace

std::vector<FarPlace> far_places(const FrontWork& work, const WorkingMesh& mesh, DeviationWatch& watch) {
  if (!work.limits_deviation()) return {};
  const std::vector<std::uint32_t> number = front_triangles(mesh);
  return watch.look(sewn_triangles(mesh, number), number);
}

std::vector<Vec3> positions_beyond(double limit, const std::vector<FarPlace>& places, double end) {
  std::vector<Vec3> positions;
  for (const FarPlace& place : places)
    if (place.distance >= limit && place.distance < end) positions.push_back(place.at);
  return positions;
}

double farthest_of(const std::vector<FarPlace>& places) {
  double farthest = 0;
  for (const FarPlace& place : places) farthest = std::max(farthest, place.distance);
  return farthest;
}

std::vector<PointSize> sizes_against(const std::vector<FarPlace>& places, double tolerance, const SizeField& sizes) {
  std::vector<PointSize> wanted;
  for (const FarPlace& place : places) {
    if (place.distance < tolerance) continue;
    const double part = std::sqrt(kAim * tolerance / place.distance);
    wanted.push_back({place.at, sizes.at(place.at) * std::max(part, kLeastPart)});
  }
  return smallest_ones(std::move(wanted));
}

}  // namespace octafront::surface
