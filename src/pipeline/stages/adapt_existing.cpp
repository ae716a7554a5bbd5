#include <octafront/adapt.h>
#include <octafront/error.h>
#include <octafront/named_groups.h>
#include <octafront/second_order.h>
#include <octafront/validity.h>

#include "adapt/metric/background.h"
#include "adapt/schedule/adapt_mesh.h"
#include "adapt/schedule/rim_metric.h"
#include "adapt/schedule/section.h"
#include "base/geometry/self_intersection.h"
#include "base/mesh/known_surface.h"
#include "pipeline/stages/adapt_section.h"
#include "pipeline/stages/stages.h"
#include "sizing/search/make_size_field.h"
#include "sizing/sources/check_size_options.h"

#include <cmath>
#include <memory>

#include <fmt/core.h>

namespace octafront {
namespace {

/// How far walls may stray where nothing is said, in parts of the diagonal: as for automatic sizes.
constexpr double kStrayOfAdapt = 0.004;

class MetricOfFunction : public adapt::MetricField {
 public:
  explicit MetricOfFunction(const MetricFunction& function) : function_(function) {}
  adapt::Metric at(Vec3 p, std::uint32_t&) const override {
    const auto m = function_(p);
    const adapt::Metric metric{m[0][0], m[0][1], m[0][2], m[1][1], m[1][2], m[2][2]};
    if (!adapt::is_metric(metric))
      throw InputError(fmt::format("the metric at ({:.6g}, {:.6g}, {:.6g}) is not positive definite", p.x, p.y, p.z));
    return metric;
  }

 private:
  const MetricFunction& function_;
};

/// Refuses what is not valid; where only parts may change these are looked at when they are known.
void require_adaptable(const TetMesh& mesh, const Run& run) {
  if (run.options.adapt.only.empty())
    if (const auto defect = first_defect(mesh, run.context())) throw InputError("not a valid mesh: " + *defect);
  const char* what = !mesh.wide_cells.empty()       ? "wedges or pyramids (boundary layers)"
                     : !mesh.periodic_nodes.empty() ? "periodic faces"
                     : !mesh.split_faces.empty()    ? "faces whose nodes were doubled"
                                                    : nullptr;
  if (what) throw InputError(fmt::format("the mesh has {}; meshes with those cannot be adapted: mesh anew", what));
}

TetMesh linear_and_adaptable(const TetMesh& mesh, Run& run) {
  TetMesh given = mesh;
  make_linear(given);
  run.stage("check of the input", [&](const Stage&) { require_adaptable(given, run); });
  return given;
}

void tell_fit(const MetricSummary& fit, const Stage& stage) {
  stage.note(
      fmt::format("{:.2f} % of the edges fit (longest {:.2f}, shortest {:.2f} of what is wanted); quality in the "
                  "metric: least {:.3f}, mean {:.3f}",
                  100.0 * static_cast<double>(fit.fitting) / static_cast<double>(std::max<std::uint64_t>(fit.edges, 1)),
                  fit.longest, fit.shortest, fit.quality_min, fit.quality_mean));
}

std::string in_words(Vec3 p) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x, p.y, p.z);
}

/// What could not be met, with the worst places.
void tell_unmet(const AdaptedMesh& result, const Stage& stage) {
  const MetricSummary& fit = result.after;
  if (fit.far > 0) {
    std::string text =
        fmt::format("{} of {} edges are not within half and twice of what is wanted", fit.far, fit.edges);
    if (fit.longest > 2) text += fmt::format("; the longest, {:.2f}, at {}", fit.longest, in_words(fit.longest_at));
    if (fit.shortest < 0.5)
      text += fmt::format("; the shortest, {:.2f}, at {}", fit.shortest, in_words(fit.shortest_at));
    stage.note(text +
               ": faces, curves and corners that must stay, and walls that curve more than the sizes follow, "
               "keep elements from them");
  }
  const WallDeviation& deviation = result.deviation;
  if (deviation.upper > deviation.bound)
    stage.note(
        fmt::format("walls are up to {:.3g} from the smooth surface of the old ones at {}, beyond the bound of "
                    "{:.3g}: elements there could not be made smaller",
                    deviation.upper, in_words(deviation.place), deviation.bound));
}

/// Walls go where the smooth surface is, each by itself: where a gap is narrower than that moves them they could meet.
adapt::Adapted adapted_without_crossings(const TetMesh& given, const adapt::MetricField& metric,
                                         adapt::AdaptRules rules, const Stage& stage) {
  adapt::Adapted made = adapt::adapt_mesh(given, metric, rules, stage);
  const auto crossings = [&] { return self_intersections(made.mesh.points, made.mesh.boundary, 1, stage.context()); };
  auto crossing = crossings();
  if (!crossing.empty() && !metric.is_isotropic()) {  // with walls less near to the ground they may not meet
    rules.walls_ahead = false;
    made = adapt::adapt_mesh(given, metric, rules, stage);
    crossing = crossings();
  }
  if (crossing.empty()) return made;
  const Vec3 p = made.mesh.points[made.mesh.boundary[crossing[0][0]][0]];
  stage.note(
      fmt::format("the boundary would have crossed itself at ({:.6g}, {:.6g}, {:.6g}), where it is near to itself: "
                  "it stays as it was, everywhere; a smaller --max-deviation may help",
                  p.x, p.y, p.z));
  rules.keep_walls = true;
  const std::vector<std::uint8_t> walls = adapt::on_walls(given);
  return adapt::adapt_mesh(given, adapt::RimMetric(given, walls, metric), rules, stage);
}

void adapt_whole(const TetMesh& given, const adapt::MetricField& metric, const adapt::AdaptRules& rules,
                 AdaptedMesh& result, Run& run) {
  run.stage("adapt", [&](const Stage& stage) {
    result.before = summary_of(adapt::fit_of(given, metric));
    adapt::Adapted made = adapted_without_crossings(given, metric, rules, stage);
    result.deviation = deviation_of(made);
    result.mesh = std::move(made.mesh);
    result.old_of_new = std::move(made.old_of_new);
    result.old_tet_of_new = adapt::same_tets(given, result.mesh, result.old_of_new);
    result.after = summary_of(adapt::fit_of(result.mesh, metric));
  });
  check_result(result.mesh, nullptr, run);
}

AdaptedMesh adapt_by(const TetMesh& given, const adapt::MetricField& metric, Run& run) {
  AdaptedMesh result;
  const double diagonal = bounding_box(given.points).diagonal();
  const SurfaceOptions& surface = run.options.surface;
  adapt::AdaptRules rules;
  rules.feature_angle = surface.angle_of_features();
  rules.strict = surface.max_deviation.has_value();
  rules.tolerance = surface.max_deviation.value_or(kStrayOfAdapt * diagonal);
  run.report.input_volume = enclosed_volume(boundary_of(given));
  const bool all = run.options.adapt.only.empty();
  (all ? adapt_whole : adapt_section)(given, metric, rules, result, run);
  run.stage("summary", [&](const Stage& stage) {
    tell_fit(result.after, stage);
    tell_unmet(result, stage);
    describe(result.mesh, run.report);
  });
  result.report = run.close();
  return result;
}

/// The sizes that the options want, asked about the boundary of the mesh.
SizeField sizes_for(const TetMesh& mesh, Run& run) {
  return run.stage("size field", [&](const Stage& stage) {
    SurfaceMesh boundary = boundary_of(mesh);
    boundary.source.clear();
    note_misplaced_sizes(boundary, run.options.size, stage);
    const KnownSurface known(std::move(boundary), run.options.surface.angle_of_features());
    SizeOptions sizes = run.options.size;
    // What is to stay near to a curved surface needs elements as small as its curvature says, as in generate().
    if (const auto bound = run.options.surface.max_deviation; bound && *bound > 0 && !sizes.chord_error && !sizes.field)
      sizes.chord_error = *bound;
    return make_size_field(known, sizes, stage);
  });
}

}  // namespace

AdaptedMesh adapt_existing(const TetMesh& mesh, const Options& options, const RunContext& context) {
  Run run(options, context);
  const TetMesh given = linear_and_adaptable(mesh, run);
  const adapt::SizeMetric metric(sizes_for(given, run));
  return adapt_by(given, metric, run);
}

AdaptedMesh adapt_to_metric(const TetMesh& mesh, const MetricFunction& metric, const Options& options,
                            const RunContext& context) {
  Run run(options, context);
  const TetMesh given = linear_and_adaptable(mesh, run);
  return adapt_by(given, MetricOfFunction(metric), run);
}

AdaptedMesh adapt_to_metric(const TetMesh& mesh, const MetricMesh& metric, const Options& options,
                            const RunContext& context) {
  Run run(options, context);
  const adapt::BackgroundMetric field(metric);
  const TetMesh given = linear_and_adaptable(mesh, run);
  return adapt_by(given, field, run);
}

}  // namespace octafront
