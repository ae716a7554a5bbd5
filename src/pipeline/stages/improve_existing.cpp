#include <octafront/error.h>
#include <octafront/improve_existing.h>
#include <octafront/named_groups.h>
#include <octafront/repair.h>
#include <octafront/validity.h>

#include "base/core/flat_map.h"
#include "base/core/renumber.h"
#include "base/mesh/labels.h"
#include "improve/curved/curved.h"
#include "improve/schedule/kept_labels.h"
#include "improve/schedule/schedule.h"
#include "periodic/paired_nodes.h"
#include "pipeline/stages/adapting.h"
#include "pipeline/stages/kept_volumes.h"
#include "pipeline/stages/periodic.h"
#include "pipeline/stages/requirements.h"
#include "pipeline/stages/stages.h"
#include "soup/tidy/examine.h"
#include "surface/remeshing/surface_check.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include <fmt/core.h>

namespace octafront {
namespace {

SurfaceMesh without_inner_points(const SurfaceMesh& surface) {
  SurfaceMesh out;
  PointsTaken taken(surface.points);
  for (const Triangle& t : surface.triangles) out.triangles.push_back(taken.take(t, out.points));
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

/// The lines of the boundary that are to stay: features, borders of patches and sets of faces, and curves, of which
/// those of other labels end where they meet.
Features lines_of(const TetMesh& mesh, double feature_angle) {
  SurfaceMesh boundary = boundary_of(mesh);
  if (has_sets(mesh, NamedSet::Kind::kFaces)) {
    boundary.patch = labels_of(mesh, NamedSet::Kind::kFaces).of;
    boundary.patch.resize(boundary.triangles.size());
  }
  Features lines = detect_features(boundary, feature_angle);
  if (mesh.curve_edges.empty()) return lines;
  FlatSet<Edge> of_boundary;
  for (const Triangle& t : mesh.boundary)
    for (std::size_t i = 0; i < 3; ++i) of_boundary.insert(sorted_edge(t[i], t[(i + 1) % 3]));
  std::map<Edge, std::uint32_t> label;
  for (const Edge& e : lines.edges) label[e] = kNone;
  const Labels curves = labels_of(mesh, NamedSet::Kind::kEdges);
  for (std::size_t e = 0; e < curves.of.size(); ++e)
    if (const Edge edge = sorted_edge(mesh.curve_edges[e][0], mesh.curve_edges[e][1]); of_boundary.contains(edge))
      label[edge] = curves.of[e];
  lines.edges.clear();
  std::map<VertexIndex, std::uint32_t> at;
  for (const auto& [edge, own] : label) {
    lines.edges.push_back(edge);
    for (const VertexIndex v : edge)
      if (const auto [other, is_first] = at.try_emplace(v, own); !is_first && other->second != own)
        lines.corners.push_back(v);
  }
  std::sort(lines.corners.begin(), lines.corners.end());
  lines.corners.erase(std::unique(lines.corners.begin(), lines.corners.end()), lines.corners.end());
  return lines;
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
  return {std::move(known), lines_of(mesh, feature_angle)};
}

void require_valid(const TetMesh& mesh, const RunContext& context) {
  if (const auto defect = first_defect(mesh, context)) throw InputError("not a valid mesh: " + *defect);
}

/// Vertices that stay where a surface is given: pairs, what is required, and where sets of nodes end.
std::vector<VertexIndex> staying_vertices(const TetMesh& mesh) {
  std::vector<VertexIndex> stay = paired_vertices(mesh);
  for (const auto& more : {required_vertices(mesh), nodes_that_stay(mesh)})
    stay.insert(stay.end(), more.begin(), more.end());
  return stay;
}

/// Says which elements keep themselves and the boundary as they are.
void tell_staying(const TetMesh& mesh, const Stage& stage) {
  const std::size_t required = improve::count_required(mesh);
  if (!mesh.wide_cells.empty())
    stage.note(fmt::format("{} wedges and pyramids, and the boundary, stay as they are", mesh.wide_cells.size()));
  if (required > 0) stage.note(fmt::format("{} required elements, and the boundary, stay as they are", required));
}

/// Nodes of sets that went.
void tell_lost_nodes(const std::vector<NamedSet>& before, const TetMesh& mesh, const Stage& stage) {
  for (std::size_t s = 0; s < mesh.sets.size(); ++s) {
    const std::size_t had = before[s].members.size(), has = mesh.sets[s].members.size();
    if (mesh.sets[s].kind == NamedSet::Kind::kNodes && has < had)
      stage.note(fmt::format("{} members of the set \"{}\" are no longer in the mesh, and left out", had - has,
                             mesh.sets[s].name));
  }
}

/// On the surface where one is given, else as the mesh was `before`.
void raise_order(TetMesh& mesh, const TetMesh& before, const Ground* ground, Run& run) {
  const int order = run.options.order;
  if (order < 2) return;
  run.stage(stage_of_order(order), [&](const Stage& stage) {
    run.report.second_order =
        ground ? curve_to_surface(mesh, ground->of_mesh.edges, ground->surface, run.options.surface.angle_of_features(),
                                  {}, paired_vertices(mesh), order, stage.context())
        : before.order() > 1 ? curve_as_before(mesh, before, order, stage.context())
                             : add_straight_edges(mesh, order, stage.context());
    count_edges(run.report.second_order, stage);
  });
}

}  // namespace

Improved improve_existing(const TetMesh& mesh, const Options& options, const SurfaceMesh* surface,
                          const RunContext& context) {
  Run run(options, context);
  Improved result;
  result.mesh = mesh;
  make_linear(result.mesh);
  // Curved elements need not be valid: they are made anew.
  run.stage("check of the input", [&](const Stage& stage) { require_valid(result.mesh, stage.context()); });
  if (mesh.order() > options.order)
    run.report.stages.back().notes.emplace_back(
        fmt::format("nodes behind the corners are left out; `order` {} keeps curved walls", mesh.order()));
  result.before = summarize_quality(mesh);
  run.report.input_volume = options.order > 1 ? curved_volume(mesh) : enclosed_volume(boundary_of(mesh));
  refuse_sizes_required(options.require, "improvement keeps the sizes that there are");
  std::optional<Ground> ground;
  if (surface && !improve::has_staying_elements(result.mesh))
    run.stage("surface", [&](const Stage& stage) {
      ground.emplace(prepare_ground(result.mesh, *surface, options.surface.angle_of_features(), stage.context()));
    });
  run.stage("improve", [&](const Stage& stage) {
    tell_staying(result.mesh, stage);
    const std::vector<NamedSet> sets = result.mesh.sets;
    std::optional<improve::BoundaryInput> on;
    if (ground)
      on.emplace(improve::BoundaryInput{ground->surface.mesh(),
                                        ground->surface.tree(),
                                        ground->surface.features(),
                                        ground->of_mesh,
                                        0,
                                        {},
                                        {},
                                        staying_vertices(result.mesh)});
    if (improve_mesh(result.mesh, on ? &*on : nullptr, options.improve, stage, ground ? &ground->of_mesh : nullptr) &&
        on)
      renew_sources(result.mesh, boundary_of(mesh), on->surface, on->tree);
    tell_lost_nodes(sets, result.mesh, stage);
  });
  divide_bridges(result.mesh, run);
  raise_order(result.mesh, mesh, ground ? &*ground : nullptr, run);
  pair_mid_nodes(result.mesh, run);
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
