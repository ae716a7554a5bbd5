#pragma once

#include <octafront/surface_mesh.h>

#include "mesh/features.h"

#include <cstdint>
#include <vector>

namespace octafront::remeshing {

/// Half-edge h = 3 * triangle + i runs from corner i of its triangle to corner i + 1; its triangle is h / 3.
using HalfedgeIndex = std::uint32_t;

constexpr HalfedgeIndex next_of(HalfedgeIndex h) {
  return h % 3 == 2 ? h - 2 : h + 1;
}
constexpr HalfedgeIndex previous_of(HalfedgeIndex h) {
  return h % 3 == 0 ? h + 2 : h - 1;
}

/// A closed manifold triangle surface with adjacency: the twin of a half-edge is the same edge in the other triangle,
/// and `twin[twin[h]] = h`. Everything else is derived.
struct HalfedgeMesh {
  std::vector<Vec3> points;
  std::vector<VertexIndex> start;        ///< per half-edge: the vertex it leaves
  std::vector<HalfedgeIndex> twin;       ///< per half-edge
  std::vector<std::uint8_t> is_feature;  ///< per half-edge, the same for both twins
  std::vector<HalfedgeIndex> outgoing;   ///< per vertex: one half-edge that leaves it; kNone if the vertex is unused

  std::size_t triangle_count() const { return start.size() / 3; }
  VertexIndex end(HalfedgeIndex h) const { return start[next_of(h)]; }
  /// The vertex opposite the half-edge in its triangle.
  VertexIndex apex(HalfedgeIndex h) const { return start[previous_of(h)]; }
  /// The next half-edge that leaves the same vertex, counter-clockwise.
  HalfedgeIndex rotated(HalfedgeIndex h) const { return twin[previous_of(h)]; }
  Vec3 corner(std::size_t triangle, int i) const { return points[start[3 * triangle + i]]; }
  /// Normal times twice the area.
  Vec3 area_vector(std::size_t triangle) const {
    const Vec3 a = corner(triangle, 0);
    return cross(corner(triangle, 1) - a, corner(triangle, 2) - a);
  }

  /// Calls visit(h) for every half-edge that leaves v, counter-clockwise.
  template <class Visit>
  void for_each_outgoing(VertexIndex v, Visit visit) const {
    const HalfedgeIndex first = outgoing[v];
    HalfedgeIndex h = first;
    do {
      visit(h);
      h = rotated(h);
    } while (h != first);
  }
  /// The half-edge from a to b, or kNone.
  HalfedgeIndex find(VertexIndex a, VertexIndex b) const;
  /// Marks the edge of h, on both sides.
  void set_feature(HalfedgeIndex h, bool feature) { is_feature[h] = is_feature[twin[h]] = feature; }
};

/// Adjacency of a closed, consistently oriented manifold surface. No edge is marked as feature.
/// Throws InputError if an edge has no partner.
HalfedgeMesh make_halfedge_mesh(const SurfaceMesh& surface);

/// Per triangle the number of its connected component, counted in order of the first triangle.
std::vector<std::uint32_t> component_of_triangle(const HalfedgeMesh& mesh, std::uint32_t& components);

}  // namespace octafront::remeshing
