#include "mesh/edge_table.h"

#include <algorithm>
#include <utility>

namespace octafront {

std::vector<std::uint32_t> EdgeTable::edge_of_half_edge() const {
  std::vector<std::uint32_t> edge_of(half_edges.size());
  for (std::size_t e = 0; e < size(); ++e)
    for (const std::uint32_t h : uses(e)) edge_of[h] = static_cast<std::uint32_t>(e);
  return edge_of;
}

EdgeTable make_edge_table(std::size_t vertices, const std::vector<Triangle>& triangles) {
  // Half-edges are dealt to buckets by their smaller vertex; what is left to sort is a handful per bucket.
  std::vector<std::uint32_t> bucket(vertices + 1, 0);
  for (const Triangle& t : triangles)
    for (int i = 0; i < 3; ++i) ++bucket[std::min(t[i], t[(i + 1) % 3]) + 1];
  for (std::size_t v = 0; v < vertices; ++v) bucket[v + 1] += bucket[v];

  using Use = std::pair<VertexIndex, std::uint32_t>;  // larger vertex, half-edge
  std::vector<Use> sorted(3 * triangles.size());
  std::vector<std::uint32_t> next(bucket.begin(), bucket.end() - 1);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (std::uint32_t i = 0; i < 3; ++i) {
      const VertexIndex a = triangles[t][i], b = triangles[t][(i + 1) % 3];
      sorted[next[std::min(a, b)]++] = {std::max(a, b), 3 * t + i};
    }
  }

  EdgeTable table;
  table.edges.reserve(sorted.size() / 2);
  table.first.reserve(sorted.size() / 2 + 1);
  table.half_edges.resize(sorted.size());
  for (VertexIndex v = 0; v < vertices; ++v) {
    std::sort(sorted.begin() + bucket[v], sorted.begin() + bucket[v + 1]);
    for (std::uint32_t k = bucket[v]; k < bucket[v + 1]; ++k) {
      if (k == bucket[v] || sorted[k].first != sorted[k - 1].first) {
        table.edges.push_back({v, sorted[k].first});
        table.first.push_back(k);
      }
      table.half_edges[k] = sorted[k].second;
    }
  }
  table.first.push_back(static_cast<std::uint32_t>(sorted.size()));
  return table;
}

}  // namespace octafront
