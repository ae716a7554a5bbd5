#include "sizing/sources/round_places.h"

#include <octafront/surface_mesh.h>

#include "base/core/parallel.h"
#include "base/geometry/measures.h"
#include "sizing/prediction/thin_walls.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <numbers>
#include <utility>

namespace octafront {

namespace {

/// Elements to a turn: chords between eleven points on a circle lose 4.1 % of a cylinder.
constexpr double kElementsPerTurn = 11;
/// Of a thickness, which is the diameter of what is round.
constexpr double kPartOfThickness = std::numbers::pi / kElementsPerTurn;
/// Where it is round, a body is so many radii of curvature thick: two, but curvature is a mean along a needle's facets.
/// Fillets have more behind them, and walls of tubes less.
constexpr double kLeastRadii = 1, kMostRadii = 4;
/// Rays begin this part of the model inside the surface, so as not to meet it where they start.
constexpr double kSkippedPlaces = 1e-7;

/// How thick the body is behind a place.
class Thickness {
 public:
  explicit Thickness(const KnownSurface& known)
      : known_(known), skipped_(kSkippedPlaces * known.tree().box().diagonal()) {}

  /// Infinite if nothing faces the place from behind within reach.
  double at(const PlaceOnSurface& place, double reach) const {
    const TriangleTree& tree = known_.tree();
    const TriangleTree::RayHit hit = tree.first_hit(place.p - skipped_ * place.n, -place.n, reach);
    if (hit.triangle == kNone) return HUGE_VAL;
    const auto& [a, b, c] = tree.corners(hit.triangle);
    return faces(unit_normal(a, b, c), place.n) ? skipped_ + hit.t : HUGE_VAL;
  }

 private:
  const KnownSurface& known_;
  double skipped_;
};

}  // namespace

SizeAtPlace sizes_in_round_places(const KnownSurface& known, const SurfaceCurvature& curvature,
                                  const std::vector<double>& face, double floor) {
  const SurfaceMesh& surface = known.mesh();
  const Thickness thickness(known);
  auto is_round = std::make_shared<std::vector<std::uint8_t>>(face.size(), 0);
  parallel_for(face.size(), [&](std::size_t f) {
    const double k = curvature.largest[f];
    const bool is_coarse = k * face[f] * kElementsPerTurn > 2 * std::numbers::pi && curvature.sum[f] > 0;
    if (!is_coarse || surface.sides_of(f)[0] != kNone) return;
    const auto& [i, j, l] = surface.triangles[f];
    const Vec3 a = surface.points[i], b = surface.points[j], c = surface.points[l];
    const double thick =
        thickness.at({centroid(a, b, c), unit_normal(a, b, c), static_cast<std::uint32_t>(f)}, kMostRadii / k);
    (*is_round)[f] = thick * k >= kLeastRadii && thick * k <= kMostRadii;
  });
  if (std::ranges::find(*is_round, 1) == is_round->end()) return {};
  const double reach = *std::ranges::max_element(face) / kPartOfThickness;
  SizeAtPlace sizes;
  sizes.at = [is_round, thickness, reach, floor](const PlaceOnSurface& place) {
    if ((*is_round)[place.face] == 0) return HUGE_VAL;
    return std::max(floor, kPartOfThickness * thickness.at(place, reach));
  };
  return sizes;
}

}  // namespace octafront
