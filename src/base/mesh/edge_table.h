#pragma once

#include <octafront/ids.h>
#include <octafront/run_context.h>

#include "base/core/raw_vector.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace octafront {

/// Edge i of triangle t, from its corner i to the next one, as h = 3 * t + i.
using HalfEdge = std::uint32_t;

constexpr HalfEdge next_of(HalfEdge h) {
  return h % 3 == 2 ? h - 2 : h + 1;
}
constexpr HalfEdge previous_of(HalfEdge h) {
  return h % 3 == 0 ? h + 2 : h - 1;
}
inline VertexIndex start_of(std::span<const Triangle> triangles, HalfEdge h) {
  return triangles[h / 3][h % 3];
}
inline VertexIndex end_of(std::span<const Triangle> triangles, HalfEdge h) {
  return start_of(triangles, next_of(h));
}

/// The undirected edges of a list of triangles, each with the half-edges that run along it.
struct EdgeTable {
  RawVector<Edge> edges;                ///< smaller vertex first, sorted, each once
  RawVector<std::uint32_t> first;       ///< one per edge and one more: where its half-edges begin in `half_edges`
  RawVector<std::uint32_t> half_edges;  ///< grouped by edge, ascending in each group

  std::size_t size() const { return edges.size(); }
  std::span<const std::uint32_t> uses(std::size_t e) const {
    return {half_edges.data() + first[e], half_edges.data() + first[e + 1]};
  }
  /// The edge that each half-edge runs along.
  RawVector<std::uint32_t> edge_of_half_edge() const;
  /// Where this is not the table of the edges of these triangles (base/core/validate.h).
  std::optional<std::string> first_inconsistency(std::span<const Triangle> triangles) const;
};

/// Requires that every index is below `vertices`. Triangles with a repeated vertex give edges with equal ends.
EdgeTable make_edge_table(std::size_t vertices, std::span<const Triangle> triangles, const RunContext& context = {});

}  // namespace octafront
