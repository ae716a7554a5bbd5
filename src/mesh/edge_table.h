#pragma once

#include <octafront/surface_mesh.h>

#include <cstddef>
#include <span>
#include <vector>

namespace octafront {

/// The undirected edges of a list of triangles, each with the half-edges that run along it.
/// Half-edge h = 3 t + i runs from corner i of triangle t to its corner (i + 1) % 3.
struct EdgeTable {
  std::vector<Edge> edges;                ///< smaller vertex first, sorted, each once
  std::vector<std::uint32_t> first;       ///< one per edge and one more: where its half-edges begin in `half_edges`
  std::vector<std::uint32_t> half_edges;  ///< grouped by edge, ascending in each group

  std::size_t size() const { return edges.size(); }
  std::span<const std::uint32_t> uses(std::size_t e) const {
    return {half_edges.data() + first[e], half_edges.data() + first[e + 1]};
  }
  /// The edge that each half-edge runs along.
  std::vector<std::uint32_t> edge_of_half_edge() const;
};

/// Requires that every index is below `vertices`. Triangles with a repeated vertex give edges with equal ends.
EdgeTable make_edge_table(std::size_t vertices, const std::vector<Triangle>& triangles);

/// Where half-edge h starts and ends.
inline VertexIndex start_of(const std::vector<Triangle>& triangles, std::uint32_t h) {
  return triangles[h / 3][h % 3];
}
inline VertexIndex end_of(const std::vector<Triangle>& triangles, std::uint32_t h) {
  return triangles[h / 3][(h % 3 + 1) % 3];
}

}  // namespace octafront
