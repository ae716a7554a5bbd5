#include "base/mesh/edge_table.h"

#include "base/core/groups.h"
#include "base/core/validate.h"

#include <algorithm>
#include <utility>

namespace octafront {

RawVector<std::uint32_t> EdgeTable::edge_of_half_edge() const {
  RawVector<std::uint32_t> edge_of(half_edges.size());
  parallel_for(size(), [&](std::size_t e) {
    for (const std::uint32_t h : uses(e)) edge_of[h] = static_cast<std::uint32_t>(e);
  });
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
  context.check();
  // Half-edges are dealt to groups by their smaller vertex; what is left to sort is a handful per group.
  struct Use {
    VertexIndex larger;
    HalfEdge half_edge;
    auto operator<=>(const Use&) const = default;
  };
  const auto half_edges = static_cast<std::uint32_t>(3 * triangles.size());
  const Groups<> of_vertex = group_by_owner(
      vertices, half_edges, [&](HalfEdge h) { return std::min(start_of(triangles, h), end_of(triangles, h)); });
  RawVector<Use> uses(half_edges);
  const auto uses_of = [&](std::size_t v) { return std::span(uses).subspan(of_vertex.first(v), of_vertex[v].size()); };
  parallel_for(vertices, [&](std::size_t v) {
    const std::span<Use> at_vertex = uses_of(v);
    for (std::size_t k = 0; k < at_vertex.size(); ++k) {
      const HalfEdge h = of_vertex[v][k];
      at_vertex[k] = {std::max(start_of(triangles, h), end_of(triangles, h)), h};
    }
    std::sort(at_vertex.begin(), at_vertex.end());
  });
  const auto begins_edge = [](std::span<const Use> at_vertex, std::size_t k) {
    return k == 0 || at_vertex[k].larger != at_vertex[k - 1].larger;
  };
  const auto for_each_edge = [&](std::size_t begin, std::size_t end, const auto& visit) {
    for (std::size_t v = begin; v < end; ++v)
      for (std::size_t k = 0; k < of_vertex[v].size(); ++k)
        if (begins_edge(uses_of(v), k)) visit(v, k);
  };
  const auto count = [&](std::size_t begin, std::size_t end) {
    std::size_t edges = 0;
    for_each_edge(begin, end, [&](std::size_t, std::size_t) { ++edges; });
    return edges;
  };
  EdgeTable table;
  table.edges.resize(half_edges);
  table.first.resize(half_edges + std::size_t{1});
  const std::size_t edges =
      number_in_blocks(vertices, count, [&](std::size_t begin, std::size_t end, std::size_t next) {
        for_each_edge(begin, end, [&](std::size_t v, std::size_t k) {
          table.edges[next] = {static_cast<VertexIndex>(v), uses_of(v)[k].larger};
          table.first[next++] = static_cast<std::uint32_t>(of_vertex.first(v) + k);
        });
        return next;
      });
  table.edges.resize(edges), table.edges.shrink_to_fit();
  table.first[edges] = half_edges;
  table.first.resize(edges + 1), table.first.shrink_to_fit();
  table.half_edges.resize(half_edges);
  parallel_for(half_edges, [&](std::size_t i) { table.half_edges[i] = uses[i].half_edge; });
  validate(table, triangles);
  return table;
}

}  // namespace octafront
