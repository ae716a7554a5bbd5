#include <octafront/surface_mesh.h>

#include "base/core/parallel.h"
#include "base/geometry/measures.h"
#include "sizing/field/thin_walls.h"
#include "sizing/sources/sources.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <numbers>

namespace octafront {

namespace {

/// Elements to a turn: chords between eleven points on a circle lose 4.1 % of a cylinder.
constexpr double kElementsPerTurn = 11;
/// Of a thickness, which is the diameter of what is round.
constexpr double kPartOfThickness = std::numbers::pi / kElementsPerTurn;
/// Where it is round, a body is so many radii of curvature thick: two, but curvature is a mean along a needle's facets.
/// Fillets have more behind them, and walls of tubes less.
constexpr double kLeastRadii = 1, kMostRadii = 4;
/// Facets so many radii long may be much thinner at an end, as a needle's are.
constexpr double kLongFacet = 8;
/// Facets on both sides of a curved wall may cross where chords lie deeper than half of its thickness.
constexpr double kPartOfWall = 0.5;
/// Both sides of a wall bend alike, to this part; noise does not.
constexpr double kUnlike = 0.3;
/// Rays begin this part of the model inside the surface, so as not to meet it where they start.
constexpr double kSkippedPlaces = 1e-7;

/// How thick the body is behind a place.
class Thickness {
 public:
  explicit Thickness(const KnownSurface& known)
      : known_(known), skipped_(kSkippedPlaces * known.tree().box().diagonal()) {}

  struct Behind {
    double thick = HUGE_VAL;
    std::uint32_t face = kNone;
  };
  /// Infinite if nothing faces the place from behind within reach.
  Behind at(const PlaceOnSurface& place, double reach) const {
    const TriangleTree& tree = known_.tree();
    const TriangleTree::RayHit hit = tree.first_hit(place.p - skipped_ * place.n, -place.n, reach);
    if (hit.triangle == kNone) return {};
    const auto& [a, b, c] = tree.corners(hit.triangle);
    if (!faces(unit_normal(a, b, c), place.n)) return {};
    return {skipped_ + hit.t, hit.triangle};
  }

 private:
  const KnownSurface& known_;
  double skipped_;
};

/// What is asked where a body is thin, of the faces where `mark` says so, from how thick it is there.
template <class Mark, class Size>
SizeAtPlace sizes_where_thin(const KnownSurface& known, const std::vector<double>& face, double floor, const Mark& mark,
                             const Size& size_for) {
  const SurfaceMesh& surface = known.mesh();
  const Thickness thickness(known);
  auto is_thin = std::make_shared<std::vector<std::uint8_t>>(face.size(), 0);
  parallel_for(face.size(), [&](std::size_t f) {
    if (surface.sides_of(f)[0] != kNone) return;
    const auto& [i, j, l] = surface.triangles[f];
    const Vec3 a = surface.points[i], b = surface.points[j], c = surface.points[l];
    (*is_thin)[f] = mark(f, [&](double reach) {
      return thickness.at({centroid(a, b, c), unit_normal(a, b, c), static_cast<std::uint32_t>(f)}, reach);
    });
  });
  if (std::ranges::find(*is_thin, 1) == is_thin->end()) return {};
  const double reach = *std::ranges::max_element(face) / kPartOfThickness;
  SizeAtPlace sizes;
  sizes.at = [is_thin, thickness, size_for, reach, floor](const PlaceOnSurface& place) {
    if ((*is_thin)[place.face] == 0) return HUGE_VAL;
    return std::max(floor, size_for(place.face, thickness.at(place, reach).thick));
  };
  return sizes;
}

}  // namespace

SizeAtPlace sizes_in_round_places(const KnownSurface& known, const SurfaceCurvature& curvature,
                                  const std::vector<double>& face, double floor) {
  const auto is_round = [&](std::size_t f, const auto& behind_within) {
    const double k = curvature.largest[f];
    if (curvature.sum[f] <= 0) return false;
    const bool is_fine = k * face[f] * kElementsPerTurn <= 2 * std::numbers::pi;
    const auto& [i, j, l] = known.mesh().triangles[f];
    const std::vector<Vec3>& p = known.mesh().points;
    if (is_fine && k * k * longest_squared_edge(p[i], p[j], p[l]) <= kLongFacet * kLongFacet) return false;
    const double thick = behind_within(kMostRadii / k).thick;
    return thick * k >= kLeastRadii && thick * k <= kMostRadii;
  };
  return sizes_where_thin(known, face, floor, is_round,
                          [](std::size_t, double thick) { return kPartOfThickness * thick; });
}

SizeAtPlace sizes_in_curved_walls(const KnownSurface& known, const SurfaceCurvature& curvature,
                                  const std::vector<double>& face, double floor) {
  // A chord of length h lies k h^2 / 8 deep. Rims of plates bend apart.
  const auto is_crossed = [&](std::size_t f, const auto& behind_within) {
    const double k = curvature.largest[f];
    if (k == 0) return false;
    const Thickness::Behind behind =
        behind_within(std::min(kLeastRadii / k, k * face[f] * face[f] / (8 * kPartOfWall)));
    return behind.face != kNone &&
           std::abs(curvature.sum[f] + curvature.sum[behind.face]) < kUnlike * std::abs(curvature.sum[f]) &&
           std::abs(k - curvature.largest[behind.face]) < kUnlike * k;
  };
  auto largest = std::make_shared<const std::vector<double>>(curvature.largest);
  return sizes_where_thin(known, face, floor, is_crossed, [largest](std::size_t f, double thick) {
    return std::sqrt(8 * kPartOfWall * thick / (*largest)[f]);
  });
}

}  // namespace octafront
