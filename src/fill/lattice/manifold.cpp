#include "fill/lattice/manifold.h"

#include "base/mesh/adjacency.h"
#include "base/mesh/renumber_mesh.h"
#include "base/mesh/surface_topology.h"

#include <algorithm>
#include <array>
#include <set>

namespace octafront {

namespace {

/// One or two vertices in which parts of the mesh touch; the second is kNone for a point.
using Pinch = std::array<VertexIndex, 2>;

bool has(const Tet& t, VertexIndex v) {
  return std::find(t.begin(), t.end(), v) != t.end();
}
bool has(const Tet& t, const Pinch& p) {
  return has(t, p[0]) && (p[1] == kNone || has(t, p[1]));
}

/// Edges of the boundary that do not have two faces; if there are none, vertices with more than one fan.
std::vector<Pinch> find_pinches(const TetMesh& mesh) {
  const std::vector<HalfEdge> twin = half_edge_twins(mesh.boundary, mesh.points.size());
  std::set<Pinch> found;
  for (HalfEdge h = 0; h < twin.size(); ++h) {
    if (twin[h] != kNone) continue;
    const VertexIndex a = start_of(mesh.boundary, h), b = end_of(mesh.boundary, h);
    found.insert({std::min(a, b), std::max(a, b)});
  }
  if (found.empty())
    for (const VertexIndex v : pinched_vertices(mesh.boundary, twin, mesh.points.size())) found.insert({v, kNone});
  return {found.begin(), found.end()};
}

/// The tetrahedra at a pinch in sets that are joined by faces which hold the pinch; all but the largest set. Of equal
/// ones the set with the lowest tetrahedron stays. All tetrahedra if there is one set only.
std::vector<TetIndex> smaller_parts(const std::vector<Tet>& tets, const std::vector<TetIndex>& star,
                                    const std::vector<HalfFace>& across, const Pinch& pinch) {
  std::vector<std::size_t> part(star.size(), star.size()), size;
  const auto place = [&](TetIndex t) {
    return static_cast<std::size_t>(std::lower_bound(star.begin(), star.end(), t) - star.begin());
  };
  for (std::size_t seed = 0; seed < star.size(); ++seed) {
    if (part[seed] != star.size()) continue;
    std::vector<std::size_t> open{seed};
    part[seed] = size.size();
    size.push_back(0);
    while (!open.empty()) {
      const std::size_t i = open.back();
      open.pop_back();
      ++size.back();
      for (int f = 0; f < 4; ++f) {
        const HalfFace other = across[4 * star[i] + static_cast<HalfFace>(f)];
        // The face opposite corner f holds the pinch if that corner is not of it.
        const VertexIndex corner = tets[star[i]][f];
        if (other == kNone || corner == pinch[0] || corner == pinch[1]) continue;
        const std::size_t j = place(other / 4);
        if (part[j] != star.size()) continue;
        part[j] = part[seed];
        open.push_back(j);
      }
    }
  }
  // Two gaps that meet in a vertex, around which the mesh is in one piece: the vertex goes.
  if (size.size() == 1) return star;
  const auto largest = static_cast<std::size_t>(std::max_element(size.begin(), size.end()) - size.begin());
  std::vector<TetIndex> smaller;
  for (std::size_t i = 0; i < star.size(); ++i)
    if (part[i] != largest) smaller.push_back(star[i]);
  return smaller;
}

std::vector<char> tets_to_drop(const TetMesh& mesh, const std::vector<HalfFace>& across,
                               const std::vector<Pinch>& pinches) {
  std::vector<char> at_pinch(mesh.points.size(), 0), drop(mesh.tets.size(), 0);
  for (const Pinch& p : pinches) at_pinch[p[0]] = 1;
  std::vector<std::pair<VertexIndex, TetIndex>> stars;
  for (TetIndex t = 0; t < mesh.tets.size(); ++t)
    for (const VertexIndex v : mesh.tets[t])
      if (at_pinch[v]) stars.emplace_back(v, t);
  std::sort(stars.begin(), stars.end());
  for (const Pinch& p : pinches) {
    std::vector<TetIndex> star;
    for (auto i = std::lower_bound(stars.begin(), stars.end(), std::pair{p[0], TetIndex{0}});
         i != stars.end() && i->first == p[0]; ++i)
      if (has(mesh.tets[i->second], p)) star.push_back(i->second);
    for (const TetIndex t : smaller_parts(mesh.tets, star, across, p)) drop[t] = 1;
  }
  return drop;
}

}  // namespace

std::size_t make_boundary_manifold(TetMesh& mesh, const RunContext& context) {
  const std::size_t before = mesh.tets.size();
  // Each round drops a tetrahedron at least, and a mesh without any has no pinches.
  for (std::vector<Pinch> pinches = find_pinches(mesh); !pinches.empty(); pinches = find_pinches(mesh)) {
    context.check();
    const std::vector<char> drop = tets_to_drop(mesh, half_face_neighbors(mesh.tets, mesh.points.size()), pinches);
    std::vector<Tet> kept;
    kept.reserve(mesh.tets.size());
    for (TetIndex t = 0; t < mesh.tets.size(); ++t)
      if (!drop[t]) kept.push_back(mesh.tets[t]);
    mesh.tets = std::move(kept);
    mesh.boundary = boundary_triangles(mesh.tets, half_face_neighbors(mesh.tets, mesh.points.size()));
  }
  if (mesh.tets.size() < before) drop_unused_points(mesh);
  return before - mesh.tets.size();
}

}  // namespace octafront
