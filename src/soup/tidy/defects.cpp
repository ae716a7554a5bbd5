#include <octafront/repair.h>

#include "base/core/parallel.h"
#include "base/core/wording.h"
#include "soup/tidy/defect_steps.h"

#include <algorithm>
#include <set>
#include <vector>

#include <fmt/core.h>

namespace octafront {
namespace {

constexpr std::size_t kShownPlaces = 3;  // per kind, in describe(): enough to look there

/// The first places that have no face in common: neighbouring faces tell nothing new.
std::vector<const SurfaceDefects::Place*> distinct_places(const SurfaceDefects::Kind& kind) {
  std::vector<const SurfaceDefects::Place*> distinct;
  std::set<std::uint32_t> shown;
  for (const SurfaceDefects::Place& place : kind.first) {
    if (distinct.size() == kShownPlaces) break;
    const bool near =
        std::any_of(place.faces.begin(), place.faces.end(), [&](std::uint32_t face) { return shown.contains(face); });
    if (near) continue;
    distinct.push_back(&place);
    shown.insert(place.faces.begin(), place.faces.end());
  }
  return distinct;
}

std::string places_of(const SurfaceDefects::Kind& kind, const char* where) {
  const auto places = distinct_places(kind);
  std::string text = kind.count > places.size() ? "first: " : "";
  for (std::size_t i = 0; i < places.size(); ++i)
    text += fmt::format("{}{} {}{}", i == 0 ? "" : "; ", where, at_point(places[i]->at), in_faces(places[i]->faces));
  return text;
}

void describe(std::string& text, const SurfaceDefects::Kind& kind, const std::string& what, const char* where,
              const char* remedy) {
  if (kind.count == 0) return;
  if (!text.empty()) text += '\n';
  text += fmt::format("{}: {}. {}", what, places_of(kind, where), remedy);
}

}  // namespace

bool SurfaceDefects::clean() const {
  for (const Kind* kind : {&open_edges, &non_manifold_edges, &misoriented_edges, &non_manifold_vertices,
                           &self_intersections, &degenerate_faces, &region_conflicts, &misplaced_parts})
    if (kind->count > 0) return false;
  return !no_faces;
}

std::string SurfaceDefects::describe() const {
  if (no_faces) return "No face is left: the input has none with an area.";
  std::string text;
  octafront::describe(text, open_edges,
                      open_loops == 0
                          ? counted(open_edges.count, "open edge")
                          : fmt::format("{} ({})", counted(open_loops, "hole"), counted(open_edges.count, "open edge")),
                      "edge at", "`octafront repair` closes holes, and joins edges that only fail to touch.");
  octafront::describe(text, non_manifold_edges, counted(non_manifold_edges.count, "edge") + " of more than two faces",
                      "edge at",
                      "`octafront repair` removes inner walls and doubled faces, and draws apart bodies that touch "
                      "there; to mesh both sides of a wall see `cells`.");
  octafront::describe(text, misoriented_edges,
                      counted(misoriented_edges.count, "edge") + " whose two faces cannot agree on an outer side",
                      "edge at", "The surface is one-sided there, like a Möbius strip: divide it or remove the faces.");
  octafront::describe(
      text, non_manifold_vertices,
      counted(non_manifold_vertices.count, "vertex", "vertices") + " where parts touch in a single point", "vertex at",
      "`octafront repair` draws them apart.");
  octafront::describe(text, self_intersections,
                      (self_intersections.count >= tidy::kMostPairs ? "at least " : "") +
                          counted(self_intersections.count, "pair") + " of faces that cut or touch each other",
                      "near",
                      "`octafront repair` unites parts that overlap, and removes what lies inside; parts with names "
                      "can be regions (`overlap`).");
  octafront::describe(text, degenerate_faces, counted(degenerate_faces.count, "face") + " without area", "at",
                      "`octafront repair` removes them and closes the gaps.");
  octafront::describe(
      text, region_conflicts,
      counted(region_conflicts.count, "edge") + " around which the regions of the faces do not agree", "edge at",
      "Each face names the regions on its two sides: between neighbouring faces both must name the same "
      "one. Add the walls that are missing there, or correct the sides.");
  octafront::describe(
      text, misplaced_parts,
      counted(misplaced_parts.count, "part") + " in another region than the outer sides of its faces say", "at",
      "Name the region that lies around the part as the one on its outer sides.");
  return text;
}

SurfaceDefects tidy::find_defects_but_crossings(const RepairedSurface& repaired, const EdgeTable& table,
                                                const RunContext& context) {
  SurfaceDefects found;
  found.no_faces = repaired.surface.triangles.empty();
  parallel_invoke([&] { find_bad_vertices(repaired, table, found); },
                  [&] {
                    find_bad_edges(repaired, table, found);
                    find_degenerate_faces(repaired, found);
                  });
  context.check();
  return found;
}

SurfaceDefects tidy::find_defects(const RepairedSurface& repaired, const EdgeTable& table, const RunContext& context) {
  if (!repaired.surface.sides.empty()) return find_complex_defects(repaired, table, context);
  SurfaceDefects found = find_defects_but_crossings(repaired, table, context);
  find_self_intersections(repaired, table, context, found);
  return found;
}

SurfaceDefects find_defects(const RepairedSurface& repaired, const RunContext& context) {
  context.check();
  const SurfaceMesh& mesh = repaired.surface;
  return tidy::find_defects(repaired, make_edge_table(mesh.points.size(), mesh.triangles, context), context);
}

}  // namespace octafront
