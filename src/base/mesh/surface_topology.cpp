#include "base/mesh/surface_topology.h"

#include "base/core/disjoint_sets.h"
#include "base/core/parallel.h"

#include <algorithm>

namespace octafront {

namespace {

bool has_repeated_vertex(const Triangle& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

// Half-edges around the start of h, while they have twins.
template <class Visit>
void walk_fan(std::span<const HalfEdge> twin, HalfEdge h, Visit&& visit) {
  HalfEdge at = h;
  do {
    visit(at);
    at = twin[previous_of(at)];
  } while (at != h && at != kNone);
}

}  // namespace

std::vector<HalfEdge> half_edge_twins(std::span<const Triangle> triangles, std::size_t vertex_count) {
  return half_edge_twins(triangles, make_edge_table(vertex_count, triangles));
}

std::vector<HalfEdge> half_edge_twins(std::span<const Triangle> triangles, const EdgeTable& table) {
  std::vector<HalfEdge> twin(3 * triangles.size(), kNone);
  parallel_for(table.size(), [&](std::size_t e) {
    if (table.uses(e).size() != 2) return;
    const HalfEdge a = table.uses(e)[0], b = table.uses(e)[1];
    if (start_of(triangles, a) == start_of(triangles, b) || start_of(triangles, a) == end_of(triangles, a)) return;
    twin[a] = b;
    twin[b] = a;
  });
  return twin;
}

std::vector<VertexIndex> pinched_vertices(std::span<const Triangle> triangles, std::span<const HalfEdge> twin,
                                          std::size_t vertex_count) {
  std::vector<bool> visited(twin.size(), false), has_fan(vertex_count, false), is_pinched(vertex_count, false);
  for (HalfEdge h = 0; h < twin.size(); ++h) {
    if (visited[h]) continue;
    const VertexIndex v = start_of(triangles, h);
    if (has_fan[v]) is_pinched[v] = true;
    has_fan[v] = true;
    walk_fan(twin, h, [&](HalfEdge around) { visited[around] = true; });
  }
  std::vector<VertexIndex> pinched;
  for (std::size_t v = 0; v < vertex_count; ++v)
    if (is_pinched[v]) pinched.push_back(static_cast<VertexIndex>(v));
  return pinched;
}

bool is_closed_manifold(std::span<const Triangle> triangles, std::size_t vertex_count) {
  if (std::any_of(triangles.begin(), triangles.end(), has_repeated_vertex)) return false;
  const std::vector<HalfEdge> twin = half_edge_twins(triangles, vertex_count);
  if (std::find(twin.begin(), twin.end(), kNone) != twin.end()) return false;
  return pinched_vertices(triangles, twin, vertex_count).empty();
}

bool is_turned_one_way(std::span<const Triangle> triangles, const EdgeTable& edges, bool closed) {
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto uses = edges.uses(e);
    if (uses.size() > 2 || (closed && uses.size() != 2)) return false;
    if (uses.size() == 2 && start_of(triangles, uses[0]) == start_of(triangles, uses[1])) return false;
  }
  return true;
}

std::vector<std::uint8_t> touching_vertices(std::span<const Triangle> triangles, const EdgeTable& edges,
                                            std::size_t vertex_count, FansOver over) {
  std::vector<std::uint8_t> touches(vertex_count, 0);
  DisjointSets fans(3 * triangles.size());  // of corners
  const auto corner_at = [&](HalfEdge h, VertexIndex v) { return start_of(triangles, h) == v ? h : next_of(h); };
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto uses = edges.uses(e);
    const bool joins = over == FansOver::kAllEdges || uses.size() == 2;
    for (const VertexIndex v : edges.edges[e]) {
      touches[v] |= !joins;
      for (std::size_t k = 1; joins && k < uses.size(); ++k) fans.join(corner_at(uses[0], v), corner_at(uses[k], v));
    }
  }
  std::vector<std::uint32_t> fan_at(vertex_count, kNone);
  for (HalfEdge h = 0; h < 3 * triangles.size(); ++h) {
    const VertexIndex v = start_of(triangles, h);
    if (fan_at[v] == kNone) fan_at[v] = fans.find(h);
    touches[v] |= fan_at[v] != fans.find(h);
  }
  return touches;
}

}  // namespace octafront
