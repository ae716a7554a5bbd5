#include <octafront/adapt.h>
#include <octafront/error.h>
#include <octafront/named_groups.h>
#include <octafront/repair.h>
#include <octafront/second_order.h>
#include <octafront/surface_mesh.h>
#include <octafront/validity.h>

#include "adapt/metric/background.h"
#include "adapt/metric/expected.h"
#include "adapt/schedule/adapt_mesh.h"
#include "adapt/schedule/rim_metric.h"
#include "adapt/schedule/section.h"
#include "base/core/disjoint_sets.h"
#include "base/mesh/edge_table.h"
#include "improve/curved/curved.h"
#include "pipeline/stages/adapting.h"
#include "pipeline/stages/kept_volumes.h"
#include "pipeline/stages/requirements.h"
#include "pipeline/stages/stages.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <fmt/core.h>

namespace octafront {
namespace {

/// Smaller pieces by more halvings are noise of the mesh.
constexpr int kMostHalvingsOfWall = 16;

/// Boundary and interfaces, as sets of faces number them.
SurfaceMesh walls_of(const TetMesh& mesh) {
  SurfaceMesh walls;
  walls.points = mesh.points;
  walls.triangles = mesh.boundary;
  walls.triangles.insert(walls.triangles.end(), mesh.interfaces.begin(), mesh.interfaces.end());
  return walls;
}

/// Per triangle the least triangle of its piece. A fillet or hole of a body is no body of its own.
std::vector<std::uint32_t> pieces_of(const SurfaceMesh& walls) {
  const EdgeTable edges = make_edge_table(walls.points.size(), walls.triangles);
  DisjointSets pieces(walls.triangles.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto uses = edges.uses(e);
    if (uses.size() == 2) pieces.join(uses[0] / 3, uses[1] / 3);
  }
  std::vector<std::uint32_t> piece(walls.triangles.size());
  for (std::uint32_t t = 0; t < piece.size(); ++t) piece[t] = pieces.find(t);
  return piece;
}

/// Adds sets of faces to the mesh, for as long as it is adapted, that may stray less than `tolerance`, which is for
/// walls as large as `diagonal`: those of connected pieces that are less than half, a quarter, ... of that. Where
/// options.surface.max_deviation is given none are.
std::vector<adapt::ToleranceOfSet> add_wall_sizes(TetMesh& mesh, const Options& options, double tolerance,
                                                  double diagonal) {
  if (options.surface.max_deviation || !(tolerance > 0)) return {};
  const SurfaceMesh walls = walls_of(mesh);
  const std::vector<std::uint32_t> piece = pieces_of(walls);
  std::vector<Box3> box(piece.size());
  for (std::size_t t = 0; t < piece.size(); ++t)
    for (const VertexIndex v : walls.triangles[t]) box[piece[t]].add(walls.points[v]);
  std::map<int, NamedSet> sets;
  for (std::uint32_t t = 0; t < piece.size(); ++t) {
    const double size = box[piece[t]].diagonal();
    const int halvings = size > 0 ? std::min(std::ilogb(diagonal / size), kMostHalvingsOfWall) : 0;
    if (halvings < 1) continue;
    NamedSet& set = sets[halvings];
    set.kind = NamedSet::Kind::kFaces;
    set.members.push_back(t);
  }
  std::vector<adapt::ToleranceOfSet> tolerances;
  for (auto& [halvings, set] : sets) {
    tolerances.push_back({static_cast<std::uint32_t>(mesh.sets.size()), std::ldexp(tolerance, -halvings), false});
    mesh.sets.push_back(std::move(set));
  }
  return tolerances;
}

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
  run.stage("check of the input", [&](const Stage& stage) {
    require_adaptable(given, run);
    if (mesh.order() > 1 && run.options.order == 1)
      stage.note(
          fmt::format("elements of order {} are taken as linear ones, without their further nodes, and stay so; "
                      "`order` {} curves the new ones along the old walls",
                      mesh.order(), mesh.order()));
  });
  return given;
}

void adapt_whole(const TetMesh& given, const adapt::MetricField& metric, const adapt::AdaptRules& rules,
                 AdaptedMesh& result, Run& run) {
  run.stage("adapt", [&](const Stage& stage) {
    require_budget(adapt::expected_tets(given, metric), stage);
    result.before = summary_of(adapt::fit_of(given, metric));
    adapt::Adapted made = adapted_with_walls_apart(given, metric, rules, stage);
    result.deviation = deviation_of(made);
    require_near(made.given);
    tell_given(made.given, stage);
    result.mesh = std::move(made.mesh);
    result.old_of_new = std::move(made.from.nodes);
    result.old_tet_of_new = adapt::same_tets(given, result.mesh, result.old_of_new);
    result.after = summary_of(adapt::fit_of(result.mesh, metric));
  });
  check_result(result.mesh, nullptr, run);
}

void divide_bridges_of(const TetMesh& given, const adapt::MetricField& metric, AdaptedMesh& result, Run& run) {
  if (!run.options.improve.no_bridging) return;
  divide_bridges(result.mesh, run);
  result.old_of_new.resize(result.mesh.points.size(), kNone);
  result.old_tet_of_new = adapt::same_tets(given, result.mesh, result.old_of_new);
  result.after = summary_of(adapt::fit_of(result.mesh, metric));
}

/// On the triangles of the surface that was given, else on the walls as they were, curved or not.
void raise_order_of(const TetMesh& before, const Domain* surface, AdaptedMesh& result, Run& run) {
  const int order = run.options.order;
  if (order < 2) return;
  run.stage(stage_of_order(order), [&](const Stage& stage) {
    const double angle = run.options.surface.angle_of_features();
    const KnownSurface walls(
        surface ? repair_surface(surface->surface, run.context()).surface : walls_with_nodes(before), angle);
    const std::vector<Edge> lines = detect_features(boundary_of(result.mesh), angle).edges;
    run.report.second_order = curve_to_surface(result.mesh, lines, walls, angle, {}, {}, order, stage.context());
    count_edges(run.report.second_order, stage);
  });
  result.old_of_new.resize(result.mesh.points.size(), kNone);
}

void refuse_order_of_parts(const Options& options) {
  if (options.order > 1 && !options.adapt.only.empty())
    throw OptionError("`order` and `only` do not go together: what is outside keeps its bits, and stays linear");
}

/// `given`: the linear mesh of `before`.
AdaptedMesh adapt_by(TetMesh& given, const TetMesh& before, const adapt::MetricField& wanted, const Domain* surface,
                     Run& run) {
  AdaptedMesh result;
  refuse_order_of_parts(run.options);
  const double diagonal = bounding_box(given.points).diagonal();
  const auto home = given_surface(surface, diagonal, run);
  adapt::AdaptRules rules = rules_of(run.options, diagonal, home ? &*home : nullptr);
  const KeptItems kept =
      run.stage("kept items", [&](const Stage& stage) { return add_kept_items(given, run.options, stage); });
  rules.kept_sets = kept.sets;
  const auto tolerances = add_wall_sizes(given, run.options, rules.tolerance, diagonal);
  rules.tolerances = tolerances;
  std::optional<adapt::RimMetric> rim;
  if (!kept.faces.empty()) rim.emplace(given, kept.faces, wanted);
  const adapt::MetricField& metric = rim ? *rim : wanted;
  const bool stays_curved = before.order() > 1 && run.options.order > 1;
  run.report.input_volume = stays_curved ? curved_volume(before) : enclosed_volume(boundary_of(given));
  const bool all = run.options.adapt.only.empty();
  (all ? adapt_whole : adapt_section)(given, metric, rules, result, run);
  drop_kept_items(result.mesh, kept);
  divide_bridges_of(given, metric, result, run);
  raise_order_of(before, surface, result, run);
  run.stage("summary", [&](const Stage& stage) {
    tell_fit(result.after, stage);
    tell_unmet(result.after, result.deviation, surface != nullptr, stage);
    describe(result.mesh, run.report);
    describe_volumes_of(given, run.report);
    note_volumes_of_mesh(run.report, stage);
    note_least(run.report, stage);
  });
  result.report = run.close();
  require_of(result.mesh, longest_edge(result.after), run.options.require, result.report);
  return result;
}

}  // namespace

AdaptedMesh adapt_existing(const TetMesh& mesh, const Options& options, const RunContext& context,
                           const Domain* surface) {
  Run run(options, context);
  TetMesh given = linear_and_adaptable(mesh, run);
  const adapt::SizeMetric metric(sizes_for(boundary_of(given), run));
  return adapt_by(given, mesh, metric, surface, run);
}

AdaptedMesh adapt_to_metric(const TetMesh& mesh, const MetricFunction& metric, const Options& options,
                            const RunContext& context, const Domain* surface) {
  Run run(options, context);
  TetMesh given = linear_and_adaptable(mesh, run);
  return adapt_by(given, mesh, MetricOfFunction(metric), surface, run);
}

AdaptedMesh adapt_to_metric(const TetMesh& mesh, const MetricMesh& metric, const Options& options,
                            const RunContext& context, const Domain* surface) {
  Run run(options, context);
  const adapt::BackgroundMetric field(metric);
  TetMesh given = linear_and_adaptable(mesh, run);
  return adapt_by(given, mesh, field, surface, run);
}

}  // namespace octafront
