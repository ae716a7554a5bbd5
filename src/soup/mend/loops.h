#pragma once

#include <octafront/ids.h>

#include "base/mesh/edge_table.h"

#include <cstdint>
#include <span>
#include <vector>

namespace octafront::mend {

/// The edge between two vertices as a key of hash tables.
constexpr std::uint64_t edge_key(VertexIndex a, VertexIndex b) {
  const auto [low, high] = sorted_edge(a, b);
  return std::uint64_t{low} << 32 | high;
}

/// The rim of a hole: its vertices in the order that triangles which close it run along it, none of them twice.
struct Loop {
  std::vector<VertexIndex> vertices;
  std::vector<std::uint32_t> triangles;  ///< at the rim, from each vertex to the next one
};

/// The closed chains of open edges, in the order of their first half-edges. Requires that neighbouring triangles agree;
/// where they do not, and where open edges end at edges of more than two triangles, there is no loop.
std::vector<Loop> find_loops(std::span<const Triangle> triangles, const EdgeTable& table);

}  // namespace octafront::mend
