#include "mesh/halfedge_mesh.h"

#include <octafront/error.h>

#include <string>

namespace octafront::remeshing {

HalfedgeIndex HalfedgeMesh::find(VertexIndex a, VertexIndex b) const {
  const HalfedgeIndex first = outgoing[a];
  HalfedgeIndex h = first;
  do {
    if (end(h) == b) return h;
    h = rotated(h);
  } while (h != first);
  return kNone;
}

namespace {

/// Half-edges sorted by the vertex they leave: those of v are list[first[v]] ... list[first[v + 1] - 1].
struct ByStart {
  std::vector<std::uint32_t> first;
  std::vector<HalfedgeIndex> list;
};

ByStart sort_by_start(const HalfedgeMesh& mesh) {
  ByStart result;
  result.first.assign(mesh.points.size() + 2, 0);
  for (const VertexIndex v : mesh.start) ++result.first[v + 2];
  for (std::size_t v = 2; v < result.first.size(); ++v) result.first[v] += result.first[v - 1];
  result.list.resize(mesh.start.size());
  for (HalfedgeIndex h = 0; h < mesh.start.size(); ++h) result.list[result.first[mesh.start[h] + 1]++] = h;
  return result;
}

}  // namespace

HalfedgeMesh make_halfedge_mesh(const SurfaceMesh& surface) {
  HalfedgeMesh mesh;
  mesh.points = surface.points;
  mesh.start.reserve(3 * surface.triangles.size());
  for (const Triangle& t : surface.triangles) mesh.start.insert(mesh.start.end(), t.begin(), t.end());
  mesh.twin.assign(mesh.start.size(), kNone);
  mesh.is_feature.assign(mesh.start.size(), 0);
  mesh.outgoing.assign(mesh.points.size(), kNone);
  const ByStart by_start = sort_by_start(mesh);
  for (HalfedgeIndex h = 0; h < mesh.start.size(); ++h) {
    mesh.outgoing[mesh.start[h]] = h;
    const VertexIndex from = mesh.end(h);
    for (std::uint32_t i = by_start.first[from]; i < by_start.first[from + 1]; ++i) {
      if (mesh.end(by_start.list[i]) == mesh.start[h]) mesh.twin[h] = by_start.list[i];
    }
    if (mesh.twin[h] == kNone) {
      throw InputError("the surface is not closed: the edge between vertices " + std::to_string(mesh.start[h]) +
                       " and " + std::to_string(from) + " has a triangle on one side only; repair it first");
    }
  }
  return mesh;
}

std::vector<std::uint32_t> component_of_triangle(const HalfedgeMesh& mesh, std::uint32_t& components) {
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

}  // namespace octafront::remeshing
