// Whether the triangles of a complex agree on what lies between them.

#include "core/disjoint_sets.h"
#include "core/wording.h"
#include "geometry/radial_order.h"
#include "mesh/complex.h"
#include "surface/defects/steps.h"
#include "surface/repair/steps.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace octafront::defects {

namespace {

/// A triangle at an edge, as one sees it that looks along the edge from its first vertex to its second: the region
/// before it and the region behind it when turning counter-clockwise, and their sides of the triangle.
struct Spoke {
  VertexIndex apex;
  std::uint32_t triangle;
  bool along;  ///< its half-edge runs along the edge

  std::uint32_t side_before() const { return 2 * triangle + (along ? 1 : 0); }
  std::uint32_t side_behind() const { return 2 * triangle + (along ? 0 : 1); }
};

std::uint32_t region_of(const SurfaceMesh& mesh, std::uint32_t side) {
  return mesh.sides[side / 2][side % 2];
}

std::vector<Spoke> spokes_of(const SurfaceMesh& mesh, const EdgeTable& table, std::size_t e) {
  std::vector<Spoke> spokes;
  for (const HalfEdge h : table.uses(e))
    spokes.push_back(
        {start_of(mesh.triangles, previous_of(h)), h / 3, start_of(mesh.triangles, h) == table.edges[e][0]});
  if (spokes.size() <= 2) return spokes;
  const auto [a, b] = table.edges[e];
  const RadialOrder order(mesh.points[a], mesh.points[b], mesh.points[spokes[0].apex]);
  std::sort(spokes.begin(), spokes.end(),
            [&](const Spoke& s, const Spoke& t) { return order(mesh.points[s.apex], mesh.points[t.apex]); });
  return spokes;
}

/// Sides of triangles that look into the same space next to an edge are joined.
void find_conflicts(const RepairedSurface& repaired, const EdgeTable& table, DisjointSets& spaces,
                    SurfaceDefects& found, std::vector<Vec3>* edges) {
  const SurfaceMesh& mesh = repaired.surface;
  FirstPlaces open(found.open_edges), conflicts(found.region_conflicts);
  for (std::size_t e = 0; e < table.size(); ++e) {
    const std::vector<Spoke> spokes = spokes_of(mesh, table, e);
    bool agree = true;
    for (std::size_t i = 0; i < spokes.size(); ++i) {
      const std::uint32_t from = spokes[i].side_behind(), to = spokes[(i + 1) % spokes.size()].side_before();
      agree = agree && region_of(mesh, from) == region_of(mesh, to);
      spaces.join(from, to);
    }
    if (agree) continue;
    std::vector<std::uint32_t> faces;
    for (const Spoke& spoke : spokes) faces.push_back(mesh.source_of(spoke.triangle));
    const auto [a, b] = table.edges[e];
    const Vec3 middle = (mesh.points[a] + mesh.points[b]) * 0.5;
    (spokes.size() == 1 ? open : conflicts).add(std::move(faces), middle);
    if (edges != nullptr) edges->push_back(middle);
  }
}

/// The spaces between the triangles as closed surfaces: two triangles for each of the complex.
struct Spaces {
  SurfaceMesh sides;  ///< side s of the complex is triangle s, facing away from its space
  repair::Pieces pieces;
};

Spaces spaces_of(const SurfaceMesh& mesh, DisjointSets& joined) {
  Spaces spaces;
  spaces.sides.points = mesh.points;
  std::map<std::uint32_t, std::uint32_t> number;
  for (std::uint32_t s = 0; s < 2 * mesh.triangles.size(); ++s) {
    const Triangle& t = mesh.triangles[s / 2];
    spaces.sides.triangles.push_back(s % 2 == 1 ? t : Triangle{t[0], t[2], t[1]});
    const auto next = static_cast<std::uint32_t>(number.size());
    spaces.pieces.piece_of_triangle.push_back(number.try_emplace(joined.find(s), next).first->second);
  }
  spaces.pieces.orientable.assign(number.size(), 1);
  return spaces;
}

/// A part of the complex that hangs together over edges has one space around it: that must be of the region that the
/// part lies in. All others are bounded, and enclose a volume.
void find_misplaced(const RepairedSurface& repaired, const EdgeTable& table, DisjointSets& joined,
                    const RunContext& context, SurfaceDefects& found) {
  const SurfaceMesh& mesh = repaired.surface;
  const Spaces spaces = spaces_of(mesh, joined);
  const std::vector<std::uint32_t>& piece_of = spaces.pieces.piece_of_triangle;
  const std::vector<int> sign = repair::volume_signs(spaces.sides, spaces.pieces);
  DisjointSets parts(mesh.triangles.size());
  for (std::size_t e = 0; e < table.size(); ++e)
    for (const HalfEdge h : table.uses(e)) parts.join(table.uses(e)[0] / 3, h / 3);
  std::vector<char> bounded(sign.size());
  for (std::size_t p = 0; p < sign.size(); ++p) bounded[p] = sign[p] >= 0;
  const repair::Nesting nesting = repair::find_nesting(spaces.sides, spaces.pieces, bounded, context);
  struct Part {
    std::uint32_t around = kNone, inner = kNone;  ///< sides of triangles
  };
  std::map<std::uint32_t, Part> part_at;
  std::vector<std::uint32_t> first_side(sign.size(), kNone);
  for (std::uint32_t s = 0; s < piece_of.size(); ++s) {
    if (first_side[piece_of[s]] == kNone) first_side[piece_of[s]] = s;
    Part& part = part_at[parts.find(s / 2)];
    std::uint32_t& place = bounded[piece_of[s]] ? part.inner : part.around;
    if (place == kNone) place = s;
  }
  FirstPlaces places(found.misplaced_parts);
  for (const auto& [first, part] : part_at) {
    if (part.inner == kNone) continue;
    const std::uint32_t outer = nesting.parent[piece_of[part.inner]];
    const std::uint32_t there = outer == kNone ? kNone : region_of(mesh, first_side[outer]);
    const std::uint32_t around = part.around == kNone ? part.inner : part.around;  // a sheet by itself
    if (region_of(mesh, around) == there) continue;
    const Triangle& t = mesh.triangles[around / 2];
    places.add({mesh.source_of(around / 2)}, (mesh.points[t[0]] + mesh.points[t[1]] + mesh.points[t[2]]) / 3);
  }
}

}  // namespace

SurfaceDefects find_complex_defects(const RepairedSurface& repaired, const EdgeTable& table,
                                    const RunContext& context) {
  SurfaceDefects found;
  found.no_faces = repaired.surface.triangles.empty();
  if (found.no_faces) return found;
  find_degenerate_faces(repaired, found);
  find_self_intersections(repaired, table, context, found);
  return found.clean() ? find_region_defects(repaired, table, context)
                       : found;  // around crossings nothing can be sorted
}

SurfaceDefects find_region_defects(const RepairedSurface& repaired, const EdgeTable& table, const RunContext& context,
                                   std::vector<Vec3>* edges) {
  SurfaceDefects found;
  DisjointSets spaces(2 * repaired.surface.triangles.size());
  find_conflicts(repaired, table, spaces, found, edges);
  if (found.clean()) find_misplaced(repaired, table, spaces, context, found);
  return found;
}

}  // namespace octafront::defects
