#pragma once

#include <octafront/ids.h>
#include <octafront/vec.h>

#include "base/mesh/edge_table.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace octafront {

struct SurfaceMesh;

/// A closed manifold triangle surface with adjacency: the twin of a half-edge is the same edge in the other triangle,
/// and `twin[twin[h]] = h`. Everything else is derived.
struct HalfEdgeMesh {
  std::vector<Vec3> points;
  std::vector<VertexIndex> start;        ///< per half-edge: the vertex it leaves
  std::vector<HalfEdge> twin;            ///< per half-edge
  std::vector<std::uint8_t> is_feature;  ///< per half-edge, the same for both twins
  std::vector<HalfEdge> outgoing;        ///< per vertex: one half-edge that leaves it; kNone if the vertex is unused

  std::size_t triangle_count() const { return start.size() / 3; }
  VertexIndex end(HalfEdge h) const { return start[next_of(h)]; }
  /// The vertex opposite the half-edge in its triangle.
  VertexIndex apex(HalfEdge h) const { return start[previous_of(h)]; }
  /// The next half-edge that leaves the same vertex, counter-clockwise.
  HalfEdge rotated(HalfEdge h) const { return twin[previous_of(h)]; }
  Vec3 corner(std::size_t triangle, int i) const { return points[start[3 * triangle + i]]; }
  /// Normal times twice the area.
  Vec3 area_vector(std::size_t triangle) const {
    const Vec3 a = corner(triangle, 0);
    return cross(corner(triangle, 1) - a, corner(triangle, 2) - a);
  }

  /// Calls visit(h) for every half-edge that leaves v, counter-clockwise.
  template <class Visit>
  void for_each_outgoing(VertexIndex v, Visit visit) const {
    const HalfEdge first = outgoing[v];
    HalfEdge h = first;
    do {
      visit(h);
      h = rotated(h);
    } while (h != first);
  }
  /// The half-edge from a to b, or kNone.
  HalfEdge find(VertexIndex a, VertexIndex b) const;
  /// Marks the edge of h, on both sides.
  void set_feature(HalfEdge h, bool feature) { is_feature[h] = is_feature[twin[h]] = feature; }

  /// Where the adjacency contradicts itself (base/core/validate.h); a triangle that starts at kNone three times is
  /// gone.
  std::optional<std::string> first_inconsistency() const;
  /// The same in the star of v.
  std::optional<std::string> first_inconsistency(VertexIndex v) const;
};

/// Adjacency of a closed, consistently oriented manifold surface. No edge is marked as feature.
/// Throws InputError if an edge has no partner.
HalfEdgeMesh make_half_edge_mesh(const SurfaceMesh& surface);
HalfEdgeMesh make_half_edge_mesh(const SurfaceMesh& surface, const EdgeTable& edges);

/// Per triangle the number of its connected component, counted in order of the first triangle.
std::vector<std::uint32_t> component_of_triangle(const HalfEdgeMesh& mesh, std::uint32_t& components);

}  // namespace octafront
