#include "base/mesh/edge_table.h"

#include "base/core/groups.h"
#include "base/core/validate.h"

#include <algorithm>
#include <utility>

namespace octafront {

std::vector<std::uint32_t> EdgeTable::edge_of_half_edge() const {
  std::vector<std::uint32_t> edge_of(half_edges.size());
  for (std::size_t e = 0; e < size(); ++e)
    for (const std::uint32_t h : uses(e)) edge_of[h] = static_cast<std::uint32_t>(e);
  return edge_of;
}

std::optional<std::string> EdgeTable::first_inconsistency(std::span<const Triangle> triangles) const {
  if (first.size() != size() + 1 || first[0] != 0 || first.back() != half_edges.size())
    return "the edges of the table do not share out its half-edges";
  if (half_edges.size() != 3 * triangles.size()) return "the table of edges has not three half-edges for each triangle";
  for (std::size_t e = 0; e < size(); ++e) {
    const auto edge = [e](const char* is_wrong) { return "edge " + std::to_string(e) + " of the table " + is_wrong; };
    if (edges[e][0] > edges[e][1]) return edge("has its larger vertex first");
    if (e > 0 && !(edges[e - 1] < edges[e])) return edge("is not behind the one before it");
    if (first[e] >= first[e + 1] || first[e + 1] > half_edges.size()) return edge("has no half-edge");
    for (std::uint32_t k = first[e]; k < first[e + 1]; ++k) {
      const HalfEdge h = half_edges[k];
      if (k > first[e] && half_edges[k - 1] >= h) return edge("has half-edges that do not ascend");
      if (h >= half_edges.size()) return edge("has a half-edge that is none");
      const VertexIndex a = start_of(triangles, h), b = end_of(triangles, h);
      if (edges[e] != Edge{std::min(a, b), std::max(a, b)}) return edge("has a half-edge that runs along another one");
    }
  }
  return std::nullopt;
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
  validate(table, triangles);
  return table;
}

}  // namespace octafront
