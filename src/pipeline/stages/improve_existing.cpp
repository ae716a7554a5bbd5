#include <octafront/error.h>
#include <octafront/improve_existing.h>
#include <octafront/named_groups.h>
#include <octafront/repair.h>
#include <octafront/validity.h>

#include "improve/curved/curved.h"
#include "improve/schedule/schedule.h"
#include "pipeline/stages/adapting.h"
#include "pipeline/stages/follow_boundary.h"
#include "pipeline/stages/kept_pairs.h"
#include "pipeline/stages/kept_volumes.h"
#include "pipeline/stages/requirements.h"
#include "pipeline/stages/stages.h"
#include "pipeline/stages/without_wide_cells.h"
#include "soup/defects/examine.h"
#include "surface/check/surface_check.h"

#include <optional>
#include <utility>

#include <fmt/core.h>

namespace octafront {
namespace {

SurfaceMesh without_inner_points(const SurfaceMesh& surface) {
  SurfaceMesh out;
  std::vector<VertexIndex> here(surface.points.size(), kNone);
  for (Triangle t : surface.triangles) {
    for (VertexIndex& v : t) {
      if (here[v] == kNone) {
        here[v] = static_cast<VertexIndex>(out.points.size());
        out.points.push_back(surface.points[v]);
      }
      v = here[v];
    }
    out.triangles.push_back(t);
  }
  return out;
}

/// A surface for the boundary to move on, and what of either must be kept.
struct Ground {
  KnownSurface surface;
  Features of_mesh;
};

/// Vertices this near to the surface, in parts of the diagonal, lie on it: files round to seven digits.
constexpr double kOnSurface = 1e-5;

void require_on_surface(const TetMesh& mesh, const SurfaceMesh& boundary, const KnownSurface& surface) {
  const double limit = kOnSurface * bounding_box(surface.mesh().points).diagonal();
  for (const Triangle& t : boundary.triangles)
    for (const VertexIndex v : t) {
      const Vec3 p = mesh.points[v];
      if (surface.tree().nearest(p, limit * limit).triangle != kNone) continue;
      throw InputError(fmt::format(
          "the boundary of the mesh does not lie on the surface given: vertex {} at ({}, {}, {}) is farther from it "
          "than {:.3g}. Give the surface that was meshed, or none: then the boundary stays as it is.",
          v, p.x, p.y, p.z, limit));
    }
}

Ground prepare_ground(const TetMesh& mesh, const SurfaceMesh& surface, double feature_angle,
                      const RunContext& context) {
  Examined found = examine_surface(surface, false, context);
  if (!found.defects.clean()) throw DefectsError(found.defects);
  SurfaceMesh& repaired = found.repaired.surface;
  // The patches of mesh and surface may be numbered differently; those of the mesh are kept as feature curves.
  repaired.patch.clear();
  Features features = detect_features(repaired, found.edges, feature_angle);
  KnownSurface known(std::move(repaired), std::move(found.edges), std::move(features));
  const SurfaceMesh boundary = boundary_of(mesh);
  require_on_surface(mesh, boundary, known);
  if (const auto defect = first_surface_defect(without_inner_points(boundary), known.mesh(), context))
    throw InputError("the boundary of the mesh cannot be moved on the surface given: " + *defect);
  return {std::move(known), detect_features(boundary, feature_angle)};
}

void require_valid(const TetMesh& mesh, const RunContext& context) {
  if (const auto defect = first_defect(mesh, context)) throw InputError("not a valid mesh: " + *defect);
}

/// The mesh as it is; what improvement does not know of leaves `mesh`.
TetMesh put_groups_aside(TetMesh& mesh) {
  TetMesh before = mesh;
  mesh.interfaces.clear();
  mesh.interface_patch.clear();
  mesh.curve_edges.clear();
  mesh.curve.clear();
  mesh.sets.clear();
  mesh.periodic_nodes.clear();
  return before;
}

/// Wedges and pyramids stay, and with them the boundary and their tetrahedra.
void improve_beside_wide_cells(TetMesh& mesh, const ImproveOptions& options, const Stage& stage) {
  stage.note(fmt::format("{} wedges and pyramids, and the boundary, stay as they are", mesh.wide_cells.size()));
  const WithoutWideCells without(mesh);
  TetMesh inner = without.inner();
  if (inner.tets.empty()) return;
  improve_mesh(inner, nullptr, options, stage);
  mesh = without.joined(std::move(inner));
}

/// Elements at what is required inside, as wide cells of one, which stay.
std::vector<WideCell> required_inside(const TetMesh& mesh) {
  std::vector<char> is_wall(mesh.points.size(), 0), is_required(mesh.points.size(), 0);
  for (const Triangle& t : mesh.boundary)
    for (const VertexIndex v : t) is_wall[v] = 1;
  bool any = false;
  for (const VertexIndex v : required_vertices(mesh)) any = (is_required[v] = !is_wall[v]) || any;
  std::vector<WideCell> cells;
  for (TetIndex t = 0; any && t < mesh.tets.size(); ++t)
    if (std::ranges::any_of(mesh.tets[t], [&](VertexIndex v) { return is_required[v] != 0; }))
      cells.push_back({t, 1, {}});
  return cells;
}

/// Without a surface that walls may move on. What is required inside stays where it is.
void improve_inside(TetMesh& mesh, const TetMesh& before, const ImproveOptions& options, const Stage& stage) {
  mesh.wide_cells = required_inside(before);
  if (mesh.wide_cells.empty()) return static_cast<void>(improve_mesh(mesh, nullptr, options, stage));
  stage.note(fmt::format("{} elements at what is required inside stay as they are", mesh.wide_cells.size()));
  const WithoutWideCells without(mesh);
  TetMesh inner = without.inner();
  if (!inner.tets.empty()) {
    improve_mesh(inner, nullptr, options, stage);
    mesh = without.joined(std::move(inner));
  }
  mesh.wide_cells.clear();
}

void raise_order(TetMesh& mesh, const Ground* ground, const std::vector<VertexIndex>& paired, Run& run) {
  if (run.options.order < 2) return;
  run.stage("second order", [&](const Stage& stage) {
    run.report.second_order =
        ground ? curve_to_surface(mesh, ground->of_mesh.edges, ground->surface, run.options.surface.angle_of_features(),
                                  {}, paired, stage.context())
               : add_straight_edges(mesh, stage.context());
    count_edges(run.report.second_order, stage);
  });
}

}  // namespace

Improved improve_existing(const TetMesh& mesh, const Options& options, const SurfaceMesh* surface,
                          const RunContext& context) {
  Run run(options, context);
  Improved result;
  run.stage("check of the input", [&](const Stage& stage) { require_valid(mesh, stage.context()); });
  result.mesh = mesh;
  make_linear(result.mesh);
  if (mesh.is_second_order() && options.order < 2)
    run.report.stages.back().notes.emplace_back("mid-side nodes are left out; `order` 2 makes new ones");
  // What improvement does not know of goes, and comes back as far as it is still there.
  const TetMesh before = put_groups_aside(result.mesh);
  const std::vector<VertexIndex> paired = paired_vertices(before);
  result.before = summarize_quality(mesh);
  run.report.input_volume = enclosed_volume(boundary_of(mesh));
  refuse_sizes_required(options.require, "improvement keeps the sizes that there are");
  std::optional<Ground> ground;
  const bool is_mixed = !result.mesh.wide_cells.empty();
  if (surface && !is_mixed)
    run.stage("surface", [&](const Stage& stage) {
      ground.emplace(prepare_ground(mesh, *surface, options.surface.angle_of_features(), stage.context()));
    });
  run.stage("improve", [&](const Stage& stage) {
    if (is_mixed) return improve_beside_wide_cells(result.mesh, options.improve, stage);
    if (!ground) return improve_inside(result.mesh, before, options.improve, stage);
    std::optional<improve::BoundaryInput> on;
    std::vector<VertexIndex> stay = paired;
    const std::vector<VertexIndex> required = required_vertices(before);
    stay.insert(stay.end(), required.begin(), required.end());
    if (ground)
      on.emplace(improve::BoundaryInput{ground->surface.mesh(),
                                        ground->surface.tree(),
                                        ground->surface.features(),
                                        ground->of_mesh,
                                        0,
                                        {},
                                        {},
                                        stay});
    if (improve_mesh(result.mesh, on ? &*on : nullptr, options.improve, stage) && on)
      renew_sources(result.mesh, boundary_of(mesh), on->surface, on->tree);
  });
  run.stage("groups", [&](const Stage& stage) {
    for (const std::string& note : carry_groups(before, result.mesh)) stage.note(note);
  });
  divide_bridges(result.mesh, run);
  raise_order(result.mesh, ground ? &*ground : nullptr, paired_now(before, result.mesh), run);
  keep_pairs(before, result.mesh, run);
  check_result(result.mesh, nullptr, run);
  run.stage("summary", [&](const Stage& stage) {
    describe(result.mesh, run.report);
    describe_volumes_of(mesh, run.report);
    note_volumes_of_mesh(run.report, stage);
    note_least(run.report, stage);
  });
  result.report = run.close();
  require_of(result.mesh, {}, options.require, result.report);
  return result;
}

}  // namespace octafront
