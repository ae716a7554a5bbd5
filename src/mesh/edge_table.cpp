#include "mesh/edge_table.h"

#include "core/groups.h"

#include <algorithm>
#include <utility>

namespace octafront {

std::vector<std::uint32_t> EdgeTable::edge_of_half_edge() const {
  std::vector<std::uint32_t> edge_of(half_edges.size());
  for (std::size_t e = 0; e < size(); ++e)
    for (const std::uint32_t h : uses(e)) edge_of[h] = static_cast<std::uint32_t>(e);
  return edge_of;
}

EdgeTable make_edge_table(std::size_t vertices, std::span<const Triangle> triangles, const RunContext& context) {
  // Half-edges are dealt to groups by their smaller vertex; what is left to sort is a handful per group.
  using Use = std::pair<VertexIndex, HalfEdge>;  // larger vertex, half-edge
  Groups<Use> uses(vertices, [&](const auto& add) {
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
      for (std::uint32_t i = 0; i < 3; ++i) {
        const VertexIndex a = triangles[t][i], b = triangles[t][(i + 1) % 3];
        add(std::min(a, b), Use{std::max(a, b), 3 * t + i});
      }
  });
  EdgeTable table;
  table.edges.reserve(uses.items().size() / 2);
  table.first.reserve(uses.items().size() / 2 + 1);
  table.half_edges.reserve(uses.items().size());
  for (VertexIndex v = 0; v < vertices; ++v) {
    if (v % 4096 == 0) context.check();
    const std::span<Use> at_vertex = uses[v];
    std::sort(at_vertex.begin(), at_vertex.end());
    for (std::size_t k = 0; k < at_vertex.size(); ++k) {
      if (k == 0 || at_vertex[k].first != at_vertex[k - 1].first) {
        table.edges.push_back({v, at_vertex[k].first});
        table.first.push_back(static_cast<std::uint32_t>(table.half_edges.size()));
      }
      table.half_edges.push_back(at_vertex[k].second);
    }
  }
  table.first.push_back(static_cast<std::uint32_t>(table.half_edges.size()));
  return table;
}

}  // namespace octafront
