
#include "base/core/parallel.h"
#include "base/geometry/measures.h"
#include "base/mesh/complex.h"
#include "pipeline/stages/methods.h"
#include "pipeline/stages/stages.h"
#include "sizing/field/affordable.h"
#include "sizing/sources/gaps.h"
#include "sizing/sources/model_extent.h"
#include "soup/coarse/decimate.h"

#include <algorithm>
#include <cmath>

namespace octafront {

namespace {

/// Edges may get this part of the least size that is asked for (.5 leaves twice the triangles and gives the same
/// meshes); they are not worth the work where that is less than this number of voxels.
constexpr double kEdge = 0.75, kLeastEdge = 1.5;
/// The part of the bound on the deviation that is spent on it, at most this part of a voxel: at .25 a tenth fewer
/// triangles are left, and lines lie so far off that corners get poor elements.
constexpr double kPartOfDeviation = 0.25, kMostDeviation = 0.1;
/// Surfaces of fewer triangles are taken as they are: all stages before the volume take a fraction of a second. So are
/// those whose edges would not become so many times as long, by which triangles are a tenth of what they were.
constexpr std::size_t kManyTriangles = 100'000;
constexpr double kMuchLonger = 4;
/// Of their mean edge: at .1 smooth bodies lose up to a tenth of a percent more of their volume, for no time gained.
constexpr double kMostOfMeanEdge = 0.05;
/// Automatic sizes are measured on what is left, and go down to a fifth of the largest: edges may get this part of
/// that, and spend so much of the deviation that is kept.
constexpr double kEdgeOfAutomatic = 0.3, kPartOfAutomatic = 0.1;

bool measures_surface(const SizeOptions& sizes) {
  return sizes.curvature || sizes.gap || sizes.through || sizes.feature_elements || sizes.facets || sizes.field ||
         sizes.mesh || sizes.callback || !sizes.point_sizes.empty();
}

/// That of the elements asked for, if all had one; or the given one.
double size_of_all(const SizeOptions& sizes, const SurfaceMesh& surface) {
  if (sizes.size) return *sizes.size;
  if (!sizes.elements) return 0;
  double volume = 0;
  for (const double v : volumes_of_regions(surface)) volume += v;
  return size_of_elements(volume, *sizes.elements);
}

/// `usual`: where nothing else is asked for.
double least_size(const SizeOptions& sizes, double usual) {
  double least = usual;
  for (const NamedSize& s : sizes.named) least = std::min(least, s.size);
  for (const NearSize& s : sizes.near) least = std::min(least, s.size);
  for (const SizeRegion& s : sizes.regions) least = std::min(least, s.size);
  return least;
}

/// Over all triangles, each edge as often as it has some.
double mean_edge(const SurfaceMesh& surface) {
  double sum = 0;
  for (const auto& [a, b, c] : surface.triangles) {
    const Vec3 p = surface.points[a], q = surface.points[b], r = surface.points[c];
    sum += distance(p, q) + distance(q, r) + distance(r, p);
  }
  return sum / (3 * static_cast<double>(surface.triangles.size()));
}

/// Whether walls or gaps are not much wider than what was moved: then the two sides may nearly touch now.
bool has_narrow(const SurfaceMesh& coarse, double moved, const RunContext& context) {
  constexpr double kClear = 4;
  const KnownSurface known(coarse, make_edge_table(coarse.points.size(), coarse.triangles, context), Features{});
  const GapFinder gaps(known, moved, kClear * moved);
  return parallel_find(coarse.triangles.size(), [&](std::size_t t) {
           const auto [a, b, c] = coarse.triangles[t];
           const Vec3 p = coarse.points[a], q = coarse.points[b], r = coarse.points[c];
           return gaps.measure({centroid(p, q, r), unit_normal(p, q, r), static_cast<std::uint32_t>(t)}) <
                  GapFinder::kOpen;
         }) < coarse.triangles.size();
}

/// Whether what is asked for leaves no triangle of the input out of sight.
bool looks_at_all(const Options& options) {
  const SurfaceOptions& surface = options.surface;
  return keeps_surface(options) || !traits_of(options.method).has_front || !options.periodic.empty() ||
         surface.normal_deviation || surface.max_deviation || surface.volume_tolerance || options.size.chord_error ||
         options.order > 1 || measures_surface(options.size);
}

}  // namespace

std::optional<SurfaceMesh> coarse_surface(const SurfaceMesh& clean, Run& run) {
  const std::size_t triangles = clean.triangles.size();
  if (triangles < kManyTriangles || !clean.sides.empty() || looks_at_all(run.options)) return {};
  const bool is_automatic = has_automatic_sizes(run.options);
  const SizeOptions& sizes = run.options.size;
  const double usual = is_automatic ? sizes.automatic_factor * base_size(clean) : size_of_all(sizes, clean);
  const double edge =
      (is_automatic ? kEdgeOfAutomatic : kEdge) * least_size(sizes, std::min(usual, sizes.max_size.value_or(HUGE_VAL)));
  const double now = mean_edge(clean);
  if (edge < kMuchLonger * now) return {};
  const double kept = is_automatic ? true_to_input(clean, run.options).max_deviation.value_or(HUGE_VAL) : HUGE_VAL;
  const double deviation = std::min(kMostOfMeanEdge * now, kPartOfAutomatic * kept);
  return run.stage("coarsen", [&](const Stage& stage) -> std::optional<SurfaceMesh> {
    SurfaceMesh coarse =
        decimated(clean, {.edge = edge, .deviation = deviation, .sharp_angle = run.options.surface.angle_of_features()},
                  stage.context());
    const bool is_narrow = has_narrow(coarse, deviation, stage.context());
    stage.count("triangles of the input", static_cast<double>(triangles));
    stage.count("triangles", static_cast<double>(is_narrow ? triangles : coarse.triangles.size()));
    if (!is_narrow) return coarse;
    stage.note("the surface stays as fine as it is: walls or gaps are narrower than its triangles");
    return {};
  });
}

std::optional<Domain> coarse_domain(const Domain& domain, Run& run) {
  const Options& options = run.options;
  const bool must_stay = keeps_surface(options) || !traits_of(options.method).has_front || !options.periodic.empty() ||
                         !domain.bound.empty() || options.surface.normal_deviation;
  if (domain.voxel_spacing == 0 || must_stay || measures_surface(options.size)) return {};
  const double edge = kEdge * least_size(options.size, size_of_all(options.size, domain.surface));
  if (edge < kLeastEdge * domain.voxel_spacing) return {};
  const double most = kMostDeviation * domain.voxel_spacing;
  const double deviation = std::min(most, kPartOfDeviation * options.surface.max_deviation.value_or(HUGE_VAL));
  return run.stage("coarsen", [&](const Stage& stage) {
    Domain coarse = domain;
    coarse.surface = decimated(
        domain.surface, {.edge = edge, .deviation = deviation, .sharp_angle = options.surface.angle_of_features()},
        stage.context());
    const bool was_clean = domain.found_clean != 0 && domain.found_clean == fingerprint(domain.surface);
    coarse.found_clean = was_clean ? fingerprint(coarse.surface) : 0;
    stage.count("triangles of the image", static_cast<double>(domain.surface.triangles.size()));
    stage.count("triangles", static_cast<double>(coarse.surface.triangles.size()));
    return coarse;
  });
}

}  // namespace octafront
