// A surface alone, adapted.

#include <octafront/adapt.h>
#include <octafront/error.h>
#include <octafront/named_groups.h>
#include <octafront/repair.h>

#include "adapt/metric/background.h"
#include "adapt/metric/expected.h"
#include "adapt/schedule/adapt_sheet.h"
#include "base/geometry/same_place.h"
#include "base/geometry/self_intersection.h"
#include "base/mesh/edge_table.h"
#include "base/mesh/known_surface.h"
#include "pipeline/stages/adapting.h"
#include "pipeline/stages/requirements.h"
#include "pipeline/stages/stages.h"

#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

namespace octafront {
namespace {

/// The surface with vertices at one place made one, and its faces turned alike: files of triangles know neither.
SurfaceMesh tidied_input(const SurfaceMesh& given, Run& run) {
  if (!run.options.adapt.only.empty())
    throw OptionError("`only` is for meshes of tetrahedra: a surface alone is adapted as a whole");
  if (run.options.order > 1)
    throw OptionError("`order` is for meshes of tetrahedra: a surface alone has flat triangles");
  if (run.options.require.angle) throw OptionError("`require_angle` is for meshes of tetrahedra");
  return run.stage("check of the input", [&](const Stage& stage) {
    RepairedSurface tidy = repair_surface(given, stage.context());
    if (tidy.surface.triangles.empty()) throw InputError("the surface has no triangles");
    for (const std::string& note : tidy.notes)
      if (!has_vertices_of_each_triangle(given)) stage.note(note);
    return std::move(tidy.surface);
  });
}

/// From numbers in a surface to those of the first vertices that were at the same places.
void renumber_as_given(std::vector<VertexIndex>& numbers, const SurfaceMesh& tidy, const SurfaceMesh& given) {
  if (tidy.points == given.points) return;
  VerticesByPlace first;
  for (VertexIndex v = 0; v < given.points.size(); ++v) first.add(given.points[v], v);
  for (VertexIndex& v : numbers)
    if (v != kNone) v = first.find(tidy.points[v]);
}

/// The vertices that sets want to stay.
std::vector<VertexIndex> kept_vertices(const SurfaceMesh& surface, std::span<const PlacedSet> sets) {
  std::set<PlaceKey> places;
  for (const PlacedSet& set : sets)
    if (keeps_vertices(set))
      for (const Vec3& p : set.places) places.insert(key_of(p));
  std::vector<VertexIndex> kept;
  for (VertexIndex v = 0; !places.empty() && v < surface.points.size(); ++v)
    if (places.contains(key_of(surface.points[v]))) kept.push_back(v);
  return kept;
}

bool is_closed(const SurfaceMesh& surface) {
  const EdgeTable edges = make_edge_table(surface.points.size(), surface.triangles);
  for (std::size_t e = 0; e < edges.size(); ++e)
    if (edges.uses(e).size() != 2) return false;
  return true;
}

/// Triangles go where the ground is, each by itself: where a gap is narrower than that moves them they could meet.
void tell_crossings(const SurfaceMesh& before, const SurfaceMesh& after, const Stage& stage) {
  const auto crossing = self_intersections(after.points, after.triangles, 1, stage.context());
  if (crossing.empty() || !self_intersections(before.points, before.triangles, 1, stage.context()).empty()) return;
  const Vec3 p = after.points[after.triangles[crossing[0][0]][0]];
  stage.note(fmt::format(
      "the surface crosses itself at ({:.6g}, {:.6g}, {:.6g}), which it did not before: it is near to itself "
      "there; a smaller --max-deviation may help",
      p.x, p.y, p.z));
}

AdaptedSurface adapt_surface_by(const SurfaceMesh& given, const adapt::MetricField& metric, const Domain* home,
                                std::span<const PlacedSet> sets, Run& run) {
  AdaptedSurface result;
  const double diagonal = bounding_box(given.points).diagonal();
  const auto on = given_surface(home, diagonal, run);
  const adapt::AdaptRules rules = rules_of(run.options, diagonal, on ? &*on : nullptr);
  const bool closed = is_closed(given);
  if (closed) run.report.input_volume = enclosed_volume(given);
  const std::vector<VertexIndex> kept = kept_vertices(given, sets);
  run.stage("adapt", [&](const Stage& stage) {
    require_budget(adapt::expected_triangles(given, metric), stage);
    if (!kept.empty()) stage.note(fmt::format("{} vertices that the file asks to keep stay as they are", kept.size()));
    result.before = summary_of(adapt::fit_of(given, metric));
    adapt::AdaptedSheet made = adapt::adapt_sheet(given, metric, rules, kept, stage);
    require_near(made.given);
    tell_given(made.given, stage);
    result.deviation = {made.deviation.bound, made.deviation.lower, made.deviation.upper, made.deviation.place};
    result.after = summary_of(adapt::fit_of(made.surface, metric));
    tell_crossings(given, made.surface, stage);
    result.surface = std::move(made.surface);
    result.old_of_new = std::move(made.old_of_new);
  });
  run.stage("summary", [&](const Stage& stage) {
    tell_fit(result.after, stage);
    tell_unmet(result.after, result.deviation, home != nullptr, stage);
    run.report.points = result.surface.points.size();
    run.report.boundary_faces = result.surface.triangles.size();
    if (closed) run.report.volume = enclosed_volume(result.surface);
  });
  result.report = run.close();
  require_of({}, longest_edge(result.after), run.options.require, result.report);
  return result;
}

}  // namespace

AdaptedSurface adapt_surface(const SurfaceMesh& surface, const Options& options, const RunContext& context,
                             const Domain* home, std::span<const PlacedSet> sets) {
  Run run(options, context);
  const SurfaceMesh tidy = tidied_input(surface, run);
  const adapt::SizeMetric metric(sizes_for(tidy, run));
  AdaptedSurface made = adapt_surface_by(tidy, metric, home, sets, run);
  renumber_as_given(made.old_of_new, tidy, surface);
  return made;
}

AdaptedSurface adapt_surface_to_metric(const SurfaceMesh& surface, const MetricMesh& metric, const Options& options,
                                       const RunContext& context, const Domain* home, std::span<const PlacedSet> sets) {
  Run run(options, context);
  const adapt::BackgroundMetric field(metric);
  const SurfaceMesh tidy = tidied_input(surface, run);
  AdaptedSurface made = adapt_surface_by(tidy, field, home, sets, run);
  renumber_as_given(made.old_of_new, tidy, surface);
  return made;
}

}  // namespace octafront
