#include <octafront/repair.h>

#include "base/core/wording.h"
#include "base/mesh/complex.h"
#include "base/mesh/surface_topology.h"
#include "soup/tidy/steps.h"

#include <fmt/core.h>

namespace octafront {
namespace {

using namespace tidy;

std::string was(std::uint64_t n) {
  return n == 1 ? "was" : "were";
}

/// The surface that the steps leave; where every triangle is the input face of its number, that need not be said.
SurfaceMesh finished(Draft& draft) {
  draft.mesh.source.clear();
  for (std::size_t t = 0; t < draft.face.size(); ++t) {
    if (draft.face[t] == t) continue;
    draft.mesh.source = std::move(draft.face);
    break;
  }
  return std::move(draft.mesh);
}

void drop_duplicates(Draft& draft, RepairedSurface& result) {
  const Duplicates done = tidy::drop_duplicates(draft);
  result.duplicate_faces += done.copies + done.sheets;
  if (done.copies > 0)
    result.notes.push_back(
        fmt::format("{} removed{}.", counted(done.copies, "duplicate face"), in_faces(done.copy_faces)));
  if (done.sheets > 0)
    result.notes.push_back(
        fmt::format("{} that lie back to back on each other removed{}: sheets without thickness bound nothing.",
                    counted(done.sheets, "face"), in_faces(done.sheet_faces)));
}

void drop_degenerate(Draft& draft, RepairedSurface& result) {
  const Degenerate done = tidy::drop_degenerate(draft);
  result.degenerate_faces += done.removed;
  result.divided_faces += done.divided;
  if (done.removed == 0) return;
  std::string note = fmt::format("{} without area removed{}", counted(done.removed, "face"), in_faces(done.faces));
  if (done.divided > 0)
    note +=
        fmt::format("; {} beside them divided at their corners, so that no gap opens", counted(done.divided, "face"));
  result.notes.push_back(note + ".");
}

void clean_faces(Draft& draft, RepairedSurface& result) {
  const bool is_soup = has_vertices_of_each_triangle(draft.mesh);
  const Merged merged = merge_vertices(draft);
  result.merged_vertices = merged.merged;
  result.unused_vertices = merged.unused;
  if (merged.merged > 0 && !is_soup)
    result.notes.push_back(
        fmt::format("{} merged into others at the same place.", counted(merged.merged, "vertex", "vertices")));
  drop_degenerate(draft, result);
  if (draft.mesh.sides.empty())
    drop_duplicates(draft, result);
  else
    clean_walls(draft, result);
  result.unused_vertices += drop_unused_vertices(draft);
  if (result.unused_vertices > 0)
    result.notes.push_back(
        fmt::format("{} removed that no face uses.", counted(result.unused_vertices, "vertex", "vertices")));
}

Pieces orient(Draft& draft, RepairedSurface& result) {
  const Pieces pieces = orient_pieces(draft);
  result.turned_faces = pieces.turned;
  if (pieces.turned > 0)
    result.notes.push_back(fmt::format("{} turned to agree with {} neighbours{}.", counted(pieces.turned, "face"),
                                       pieces.turned == 1 ? "its" : "their", in_faces(pieces.turned_faces)));
  InputFaces first_faces;
  std::uint32_t next = 0;
  for (std::size_t t = 0; t < draft.face.size(); ++t) {
    if (pieces.piece_of_triangle[t] != next) continue;
    if (!pieces.orientable[next]) first_faces.push_back(draft.face[t]);
    ++next;
  }
  if (!first_faces.empty())
    result.notes.push_back(fmt::format("{} cannot be oriented, like a Möbius strip{}.",
                                       counted(first_faces.size(), "piece of the surface", "pieces of the surface"),
                                       in_faces(first_faces)));
  return pieces;
}

void nest(Draft& draft, const Pieces& pieces, RepairedSurface& result) {
  const Shells shells = orient_shells(draft, pieces);
  result.shells = pieces.count();
  result.cavities = shells.cavities;
  result.bodies = shells.bodies;
  result.turned_shells = shells.inside_out + shells.turned_cavities;
  result.turned_cavities = shells.turned_cavities;
  result.body_of_triangle.reserve(draft.face.size());
  for (const std::uint32_t piece : pieces.piece_of_triangle)
    result.body_of_triangle.push_back(shells.body_of_piece[piece]);
  if (shells.inside_out > 0)
    result.notes.push_back(fmt::format("{} {} inside out and {} turned{}.", counted(shells.inside_out, "shell"),
                                       was(shells.inside_out), was(shells.inside_out),
                                       in_faces(shells.inside_out_faces)));
  if (shells.turned_cavities > 0)
    result.notes.push_back(fmt::format("{} inside others {} turned to bound cavities{}.",
                                       counted(shells.turned_cavities, "shell"), was(shells.turned_cavities),
                                       in_faces(shells.turned_cavity_faces)));
}

}  // namespace

Draft tidy::make_draft(const SurfaceMesh& soup, const RunContext& context) {
  context.check();
  check_input(soup);
  Draft draft{soup, std::vector<std::uint32_t>(soup.triangles.size()), context};
  for (std::size_t t = 0; t < draft.face.size(); ++t) draft.face[t] = soup.source_of(t);
  return draft;
}

RepairedSurface tidy::tidied(Draft& draft) {
  RepairedSurface result;
  // One region may touch itself in edges and points: as a complex it can be meshed, as a plain surface it cannot.
  if (!draft.mesh.sides.empty() && !is_complex(draft.mesh) &&
      is_closed_manifold(draft.mesh.triangles, draft.mesh.points.size()))
    draft.mesh.sides.clear();
  clean_faces(draft, result);
  if (!draft.mesh.sides.empty()) {
    result.surface = finished(draft);
    return result;
  }
  const Pieces pieces = orient(draft, result);
  nest(draft, pieces, result);
  result.surface = finished(draft);
  return result;
}

bool has_vertices_of_each_triangle(const SurfaceMesh& surface) {
  return surface.points.size() == 3 * surface.triangles.size();
}

RepairedSurface repair_surface(const SurfaceMesh& soup, const RunContext& context) {
  Draft draft = make_draft(soup, context);
  return tidied(draft);
}

}  // namespace octafront
