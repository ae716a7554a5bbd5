// Whether the triangles of a complex agree on what lies between them.

#include "base/core/disjoint_sets.h"
#include "base/geometry/radial_order.h"
#include "base/geometry/sight_line.h"
#include "soup/tidy/defect_steps.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

namespace octafront::tidy {

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

/// Sides of triangles that look into the same space next to an edge must be of one region.
void find_conflicts(const RepairedSurface& repaired, const EdgeTable& table, SurfaceDefects& found,
                    std::vector<Vec3>* edges) {
  const SurfaceMesh& mesh = repaired.surface;
  FirstPlaces open(found.open_edges), conflicts(found.region_conflicts);
  for (std::size_t e = 0; e < table.size(); ++e) {
    const std::vector<Spoke> spokes = spokes_of(mesh, table, e);
    bool agree = true;
    for (std::size_t i = 0; i < spokes.size(); ++i) {
      const std::uint32_t from = spokes[i].side_behind(), to = spokes[(i + 1) % spokes.size()].side_before();
      agree = agree && region_of(mesh, from) == region_of(mesh, to);
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

/// Parts of the complex that hang together over edges.
DisjointSets parts_of_sides(const SurfaceMesh& mesh, const EdgeTable& table) {
  DisjointSets parts(mesh.triangles.size());
  for (std::size_t e = 0; e < table.size(); ++e)
    for (const HalfEdge h : table.uses(e)) parts.join(table.uses(e)[0] / 3, h / 3);
  return parts;
}

/// A part has one space around it, which must be of the region that the part lies in. What a line sees between two
/// triangles that it crosses one after the other is one space, and lines through all parts tell which spaces are one.
void find_misplaced(const RepairedSurface& repaired, const EdgeTable& table, const RunContext& context,
                    SurfaceDefects& found, std::vector<Vec3>* all) {
  const SurfaceMesh& mesh = repaired.surface;
  DisjointSets parts = parts_of_sides(mesh, table);
  std::vector<std::uint8_t> has_line(mesh.triangles.size(), 0), is_misplaced(mesh.triangles.size(), 0);
  FirstPlaces places(found.misplaced_parts);
  const auto complain = [&](std::uint32_t t) {
    if (std::exchange(is_misplaced[parts.find(t)], 1) != 0) return;
    const auto& [a, b, c] = mesh.triangles[t];
    const Vec3 middle = (mesh.points[a] + mesh.points[b] + mesh.points[c]) / 3;
    places.add({mesh.source_of(t)}, middle);
    if (all) all->push_back(middle);
  };
  const SightLines lines(mesh.points, mesh.triangles);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::optional<SightLines::Line> line = has_line[parts.find(t)] == 0 ? lines.line_through(t) : std::nullopt;
    if (!line) continue;
    context.check();
    has_line[parts.find(t)] = 1;
    std::set<std::uint32_t> entered;
    std::uint32_t here = kNone, last = kNone;
    for (const SightLines::Crossing& c : lines.crossings(line->p, line->axis)) {
      // Where a part is seen for the first time, the space before it is the one around it.
      const bool enters = entered.insert(parts.find(c.triangle)).second;
      if (region_of(mesh, c.below()) != here) complain(enters ? c.triangle : last);
      here = region_of(mesh, c.above());
      last = c.triangle;
    }
    if (here != kNone) complain(last);
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
                                   std::vector<Vec3>* places) {
  SurfaceDefects found;
  find_conflicts(repaired, table, found, places);
  if (found.clean()) find_misplaced(repaired, table, context, found, places);
  return found;
}

}  // namespace octafront::tidy
