#include "base/mesh/half_edge_mesh.h"

#include <octafront/error.h>
#include <octafront/surface_mesh.h>

#include "base/core/validate.h"
#include "base/mesh/surface_topology.h"

#include <string>

namespace octafront {

HalfEdge HalfEdgeMesh::find(VertexIndex a, VertexIndex b) const {
  const HalfEdge first = outgoing[a];
  HalfEdge h = first;
  do {
    if (end(h) == b) return h;
    h = rotated(h);
  } while (h != first);
  return kNone;
}

HalfEdgeMesh make_half_edge_mesh(const SurfaceMesh& surface) {
  return make_half_edge_mesh(surface, make_edge_table(surface.points.size(), surface.triangles));
}

HalfEdgeMesh make_half_edge_mesh(const SurfaceMesh& surface, const EdgeTable& edges) {
  HalfEdgeMesh mesh;
  mesh.points = surface.points;
  mesh.start.reserve(3 * surface.triangles.size());
  for (const Triangle& t : surface.triangles) mesh.start.insert(mesh.start.end(), t.begin(), t.end());
  mesh.twin = half_edge_twins(surface.triangles, edges);
  mesh.is_feature.assign(mesh.start.size(), 0);
  mesh.outgoing.assign(mesh.points.size(), kNone);
  for (HalfEdge h = 0; h < mesh.start.size(); ++h) {
    mesh.outgoing[mesh.start[h]] = h;
    if (mesh.twin[h] != kNone) continue;
    throw InputError("the surface is not closed: the edge between vertices " + std::to_string(mesh.start[h]) + " and " +
                     std::to_string(mesh.end(h)) + " has a triangle on one side only; repair it first");
  }
  validate(mesh);
  return mesh;
}

namespace {

std::string name_of_half_edge(HalfEdge h) {
  return "half-edge " + std::to_string(h);
}

std::optional<std::string> wrong_at_half_edge(const HalfEdgeMesh& mesh, HalfEdge h) {
  const HalfEdge g = mesh.twin[h];
  if (g >= mesh.start.size()) return name_of_half_edge(h) + " has no twin";
  if (mesh.twin[g] != h) return name_of_half_edge(g) + " does not know its twin, " + name_of_half_edge(h);
  if (mesh.start[g] != mesh.end(h) || mesh.end(g) != mesh.start[h])
    return name_of_half_edge(h) + " and its twin, " + name_of_half_edge(g) +
           ", do not run along one edge in opposite directions";
  if (mesh.start[h] == mesh.end(h)) return name_of_half_edge(h) + " ends where it starts";
  if (mesh.is_feature[h] != mesh.is_feature[g]) return name_of_half_edge(h) + " and its twin are not both features";
  return std::nullopt;
}

/// Half-edges that leave each vertex, or what is wrong with the arrays.
std::optional<std::string> count_starts(const HalfEdgeMesh& mesh, std::vector<std::uint32_t>& count) {
  const std::size_t half_edges = mesh.start.size();
  if (half_edges % 3 != 0 || mesh.twin.size() != half_edges || mesh.is_feature.size() != half_edges)
    return "the arrays of half-edges differ in length";
  if (mesh.outgoing.size() != mesh.points.size()) return "the arrays of vertices differ in length";
  count.assign(mesh.points.size(), 0);
  for (HalfEdge h = 0; h < half_edges; ++h) {
    if (mesh.start[h] == kNone && mesh.end(h) == kNone) continue;
    if (mesh.start[h] >= mesh.points.size()) return name_of_half_edge(h) + " leaves a vertex that there is not";
    ++count[mesh.start[h]];
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> HalfEdgeMesh::first_inconsistency(VertexIndex v) const {
  const HalfEdge first = outgoing[v];
  if (first == kNone) return std::nullopt;
  // Who looks at both sides before going on comes back: no half-edge is reached from two.
  for (HalfEdge h = first;;) {
    if (h >= start.size() || start[h] != v)
      return name_of_half_edge(h) + " is given as leaving vertex " + std::to_string(v) + ", and does not";
    for (const HalfEdge side : {h, previous_of(h)})
      if (auto wrong = wrong_at_half_edge(*this, side)) return wrong;
    h = rotated(h);
    if (h == first) return std::nullopt;
  }
}

std::optional<std::string> HalfEdgeMesh::first_inconsistency() const {
  std::vector<std::uint32_t> count;
  if (auto wrong = count_starts(*this, count)) return wrong;
  for (VertexIndex v = 0; v < points.size(); ++v) {
    if (auto wrong = first_inconsistency(v)) return wrong;
    std::uint32_t in_star = 0;
    if (outgoing[v] != kNone) for_each_outgoing(v, [&](HalfEdge) { ++in_star; });
    if (in_star != count[v]) return "the star of vertex " + std::to_string(v) + " lacks triangles that have it";
  }
  return std::nullopt;
}

std::vector<std::uint32_t> component_of_triangle(const HalfEdgeMesh& mesh, std::uint32_t& components) {
  std::vector<std::uint32_t> component(mesh.triangle_count(), kNone);
  std::vector<std::uint32_t> stack;
  components = 0;
  for (std::uint32_t seed = 0; seed < component.size(); ++seed) {
    if (component[seed] != kNone) continue;
    component[seed] = components;
    stack.assign(1, seed);
    while (!stack.empty()) {
      const std::uint32_t t = stack.back();
      stack.pop_back();
      for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
        const std::uint32_t other = mesh.twin[h] / 3;
        if (component[other] != kNone) continue;
        component[other] = components;
        stack.push_back(other);
      }
    }
    ++components;
  }
  return component;
}

}  // namespace octafront
