// What is mended of a complex, where a triangle says what lies on its two sides.

#include "base/core/wording.h"
#include "base/mesh/complex.h"
#include "base/mesh/face_table.h"
#include "soup/tidy/steps.h"

#include <set>

#include <fmt/core.h>

namespace octafront::tidy {

namespace {

/// The sides of t as `like`, on the same three vertices, is turned.
Sides sides_along(const SurfaceMesh& mesh, std::uint32_t t, std::uint32_t like) {
  const auto [front, behind] = mesh.sides[t];
  return is_even(mesh.triangles[t]) == is_even(mesh.triangles[like]) ? Sides{front, behind} : Sides{behind, front};
}

/// Of triangles on the same vertices one stays where they agree, or where each knows the region on one side only: two
/// bodies that share a face, each with a triangle of its own. Others stay, and are found to intersect.
void join_walls(Draft& draft, RepairedSurface& result) {
  SurfaceMesh& mesh = draft.mesh;
  std::vector<char> marked(mesh.triangles.size(), 0);
  InputFaces copies;
  face_table(mesh.points.size(), mesh.triangles)
      .for_each_group([&](const Triangle&, std::span<const FaceTable::Entry> group) {
        const std::uint32_t first = group[0].face;
        for (const FaceTable::Entry& entry : group.subspan(1)) {
          const Sides other = sides_along(mesh, entry.face, first);
          Sides& sides = mesh.sides[first];
          const bool fits = sides[0] == kNone && other[1] == kNone   ? (sides[0] = other[0], true)
                            : sides[1] == kNone && other[0] == kNone ? (sides[1] = other[1], true)
                                                                     : sides == other;
          if (!fits) continue;
          marked[entry.face] = 1;
          copies.push_back(draft.face[entry.face]);
        }
      });
  if (copies.empty()) return;
  drop_marked(draft, marked);
  sort_unique(copies);
  result.duplicate_faces += copies.size();
  result.notes.push_back(
      fmt::format("{} joined with others at the same place{}.", counted(copies.size(), "face"), in_faces(copies)));
}

/// Triangles with nothing on either side bound nothing.
void drop_idle(Draft& draft, RepairedSurface& result) {
  std::vector<char> marked(draft.mesh.triangles.size(), 0);
  InputFaces idle;
  for (std::size_t t = 0; t < marked.size(); ++t) {
    if (draft.mesh.sides[t] != Sides{kNone, kNone}) continue;
    marked[t] = 1;
    idle.push_back(draft.face[t]);
  }
  if (idle.empty()) return;
  drop_marked(draft, marked);
  sort_unique(idle);
  result.notes.push_back(
      fmt::format("{} removed with no region on either side{}.", counted(idle.size(), "face"), in_faces(idle)));
}

/// Turns the triangles of sheets, whose sides say nothing of it, to agree with their neighbours. One-sided sheets keep
/// an edge where they do not.
void orient_sheets(Draft& draft) {
  SurfaceMesh& mesh = draft.mesh;
  const EdgeTable& table = draft.edges();
  const auto is_sheet = [&](std::uint32_t t) { return mesh.sides[t][0] == mesh.sides[t][1]; };
  const RawVector<std::uint32_t> edge_of = table.edge_of_half_edge();
  std::vector<char> seen(mesh.triangles.size(), 0), turn(mesh.triangles.size(), 0);
  std::vector<std::uint32_t> stack;
  for (std::uint32_t seed = 0; seed < seen.size(); ++seed) {
    if (seen[seed] || !is_sheet(seed)) continue;
    seen[seed] = 1;
    stack.assign(1, seed);
    while (!stack.empty()) {
      const std::uint32_t t = stack.back();
      stack.pop_back();
      for (HalfEdge h = 3 * t; h < 3 * t + 3; ++h) {
        const auto uses = table.uses(edge_of[h]);
        if (uses.size() != 2) continue;
        const HalfEdge g = uses[0] == h ? uses[1] : uses[0];
        if (seen[g / 3] || !is_sheet(g / 3)) continue;
        seen[g / 3] = 1;
        turn[g / 3] = turn[t] != (start_of(mesh.triangles, g) == start_of(mesh.triangles, h));
        stack.push_back(g / 3);
      }
    }
  }
  for (std::size_t t = 0; t < turn.size(); ++t)
    if (turn[t]) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
}

}  // namespace

void clean_walls(Draft& draft, RepairedSurface& result) {
  drop_idle(draft, result);
  join_walls(draft, result);
  face_lower_regions_behind(draft.mesh);
  draft.known_edges.reset();
  orient_sheets(draft);
  draft.known_edges.reset();
  std::set<std::uint32_t> regions;
  for (const Sides& sides : draft.mesh.sides) regions.insert(sides.begin(), sides.end());
  regions.erase(kNone);
  result.bodies = static_cast<std::uint32_t>(regions.size());
}

}  // namespace octafront::tidy
