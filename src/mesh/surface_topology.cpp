#include "mesh/surface_topology.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace octafront {

namespace {

// Half-edges by the lower vertex of their edge, then the higher one, then their number.
struct EdgeTable {
  struct Entry {
    VertexIndex high;
    HalfEdge half_edge;
  };
  std::vector<std::uint32_t> first_of_vertex;
  std::vector<Entry> entries;

  EdgeTable(std::span<const Triangle> triangles, std::size_t vertex_count) : first_of_vertex(vertex_count + 2, 0) {
    const auto n = static_cast<HalfEdge>(3 * triangles.size());
    for (HalfEdge h = 0; h < n; ++h) ++first_of_vertex[std::min(start_of(triangles, h), end_of(triangles, h)) + 2];
    std::partial_sum(first_of_vertex.begin(), first_of_vertex.end(), first_of_vertex.begin());
    entries.resize(n);
    for (HalfEdge h = 0; h < n; ++h) {
      const auto [low, high] = std::minmax({start_of(triangles, h), end_of(triangles, h)});
      entries[first_of_vertex[low + 1]++] = {high, h};
    }
    first_of_vertex.pop_back();
    for (std::size_t v = 0; v < vertex_count; ++v)
      std::sort(entries.begin() + first_of_vertex[v], entries.begin() + first_of_vertex[v + 1],
                [](const Entry& a, const Entry& b) {
                  return a.high != b.high ? a.high < b.high : a.half_edge < b.half_edge;
                });
  }

  template <class Visit>
  void for_each_edge(Visit&& visit) const {
    for (std::size_t v = 0; v + 1 < first_of_vertex.size(); ++v) {
      const std::size_t end = first_of_vertex[v + 1];
      for (std::size_t i = first_of_vertex[v], j = i; i < end; i = j) {
        while (j < end && entries[j].high == entries[i].high) ++j;
        visit(std::span(entries).subspan(i, j - i));
      }
    }
  }
};

bool has_repeated_vertex(const Triangle& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

// Half-edges around the start of h, while they have twins.
template <class Visit>
void walk_fan(std::span<const HalfEdge> twin, HalfEdge h, Visit&& visit) {
  HalfEdge at = h;
  do {
    visit(at);
    at = twin[previous_in_triangle(at)];
  } while (at != h && at != kNone);
}

}  // namespace

std::vector<HalfEdge> half_edge_twins(std::span<const Triangle> triangles, std::size_t vertex_count) {
  std::vector<HalfEdge> twin(3 * triangles.size(), kNone);
  EdgeTable(triangles, vertex_count).for_each_edge([&](std::span<const EdgeTable::Entry> on_edge) {
    if (on_edge.size() != 2) return;
    const HalfEdge a = on_edge[0].half_edge, b = on_edge[1].half_edge;
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

Shells find_shells(std::span<const Triangle> triangles, std::span<const HalfEdge> twin, std::size_t vertex_count) {
  Shells result;
  result.of_triangle.assign(triangles.size(), kNone);
  // Last shell that counted a vertex: shells that touch at a vertex each count it.
  std::vector<std::uint32_t> counted_by(vertex_count, kNone);
  std::vector<std::uint32_t> stack;
  for (std::uint32_t seed = 0; seed < triangles.size(); ++seed) {
    if (result.of_triangle[seed] != kNone) continue;
    const auto number = static_cast<std::uint32_t>(result.shells.size());
    Shells::Shell shell;
    result.of_triangle[seed] = number;
    stack.assign(1, seed);
    while (!stack.empty()) {
      const std::uint32_t t = stack.back();
      stack.pop_back();
      ++shell.triangles;
      for (HalfEdge h = 3 * t; h < 3 * t + 3; ++h) {
        const VertexIndex v = start_of(triangles, h);
        if (std::exchange(counted_by[v], number) != number) ++shell.vertices;
        if (twin[h] == kNone || h < twin[h]) ++shell.edges;
        if (twin[h] == kNone || result.of_triangle[twin[h] / 3] != kNone) continue;
        result.of_triangle[twin[h] / 3] = number;
        stack.push_back(twin[h] / 3);
      }
    }
    result.shells.push_back(shell);
  }
  return result;
}

std::vector<Edge> edges_of(std::span<const Triangle> triangles) {
  std::vector<Edge> edges;
  edges.reserve(3 * triangles.size());
  for (const Triangle& t : triangles)
    for (int i = 0; i < 3; ++i) {
      const VertexIndex a = t[i], b = t[(i + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b)});
    }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

}  // namespace octafront
