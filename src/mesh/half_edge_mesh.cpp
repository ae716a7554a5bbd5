#include "mesh/half_edge_mesh.h"

#include <octafront/error.h>

#include "mesh/surface_topology.h"

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
  return mesh;
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
