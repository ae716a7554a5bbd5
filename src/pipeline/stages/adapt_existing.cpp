#include <octafront/adapt.h>
#include <octafront/error.h>
#include <octafront/named_groups.h>
#include <octafront/second_order.h>
#include <octafront/validity.h>

#include "adapt/metric/background.h"
#include "adapt/schedule/adapt_mesh.h"
#include "adapt/schedule/section.h"
#include "pipeline/stages/adapt_section.h"
#include "pipeline/stages/adapting.h"
#include "pipeline/stages/stages.h"
#include "pipeline/stages/walls_apart.h"

#include <cmath>
#include <memory>

#include <fmt/core.h>

namespace octafront {
namespace {

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

void adapt_whole(const TetMesh& given, const adapt::MetricField& metric, const adapt::AdaptRules& rules,
                 AdaptedMesh& result, Run& run) {
  run.stage("adapt", [&](const Stage& stage) {
    result.before = summary_of(adapt::fit_of(given, metric));
    adapt::Adapted made = adapted_with_walls_apart(given, metric, rules, stage);
    result.deviation = deviation_of(made);
    require_near(made.given);
    tell_given(made.given, stage);
    result.mesh = std::move(made.mesh);
    result.old_of_new = std::move(made.old_of_new);
    result.old_tet_of_new = adapt::same_tets(given, result.mesh, result.old_of_new);
    result.after = summary_of(adapt::fit_of(result.mesh, metric));
  });
  check_result(result.mesh, nullptr, run);
}

AdaptedMesh adapt_by(const TetMesh& given, const adapt::MetricField& metric, const Domain* surface, Run& run) {
  AdaptedMesh result;
  const double diagonal = bounding_box(given.points).diagonal();
  const auto home = given_surface(surface, diagonal, run);
  const adapt::AdaptRules rules = rules_of(run.options, diagonal, home ? &*home : nullptr);
  run.report.input_volume = enclosed_volume(boundary_of(given));
  const bool all = run.options.adapt.only.empty();
  (all ? adapt_whole : adapt_section)(given, metric, rules, result, run);
  run.stage("summary", [&](const Stage& stage) {
    tell_fit(result.after, stage);
    tell_unmet(result.after, result.deviation, surface != nullptr, stage);
    describe(result.mesh, run.report);
  });
  result.report = run.close();
  return result;
}

}  // namespace

AdaptedMesh adapt_existing(const TetMesh& mesh, const Options& options, const RunContext& context,
                           const Domain* surface) {
  Run run(options, context);
  const TetMesh given = linear_and_adaptable(mesh, run);
  const adapt::SizeMetric metric(sizes_for(boundary_of(given), run));
  return adapt_by(given, metric, surface, run);
}

AdaptedMesh adapt_to_metric(const TetMesh& mesh, const MetricFunction& metric, const Options& options,
                            const RunContext& context, const Domain* surface) {
  Run run(options, context);
  const TetMesh given = linear_and_adaptable(mesh, run);
  return adapt_by(given, MetricOfFunction(metric), surface, run);
}

AdaptedMesh adapt_to_metric(const TetMesh& mesh, const MetricMesh& metric, const Options& options,
                            const RunContext& context, const Domain* surface) {
  Run run(options, context);
  const adapt::BackgroundMetric field(metric);
  const TetMesh given = linear_and_adaptable(mesh, run);
  return adapt_by(given, field, surface, run);
}

}  // namespace octafront
