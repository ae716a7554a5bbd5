#pragma once

#include <octafront/surface_mesh.h>

#include <cstdint>
#include <span>
#include <vector>

namespace octafront {

/// Edge i of triangle t, from its corner i to the next one, as h = 3 * t + i.
using HalfEdge = std::uint32_t;

constexpr HalfEdge next_in_triangle(HalfEdge h) {
  return h % 3 == 2 ? h - 2 : h + 1;
}
constexpr HalfEdge previous_in_triangle(HalfEdge h) {
  return h % 3 == 0 ? h + 2 : h - 1;
}
inline VertexIndex start_of(std::span<const Triangle> triangles, HalfEdge h) {
  return triangles[h / 3][h % 3];
}
inline VertexIndex end_of(std::span<const Triangle> triangles, HalfEdge h) {
  return start_of(triangles, next_in_triangle(h));
}

/// For each half-edge the one that runs the other way on the same edge, twin[twin[h]] = h; kNone where the edge does
/// not have exactly two triangles that run through it in opposite directions. Requires vertex indices in range.
std::vector<HalfEdge> half_edge_twins(std::span<const Triangle> triangles, std::size_t vertex_count);

/// True if each edge has exactly two triangles, in opposite directions, and the triangles around each vertex form one
/// fan; no triangle has a vertex twice. (Vertices without triangles do not matter.)
bool is_closed_manifold(std::span<const Triangle> triangles, std::size_t vertex_count);

/// Vertices whose triangles form more than one fan, ascending. `twin` as above; requires a surface whose edges all have
/// twins.
std::vector<VertexIndex> pinched_vertices(std::span<const Triangle> triangles, std::span<const HalfEdge> twin,
                                          std::size_t vertex_count);

/// Triangles connected across edges.
struct Shells {
  std::vector<std::uint32_t> of_triangle;  ///< numbered in order of their first triangle
  struct Shell {
    std::uint64_t vertices = 0, edges = 0, triangles = 0;
    std::int64_t euler_characteristic() const {
      return static_cast<std::int64_t>(vertices + triangles) - static_cast<std::int64_t>(edges);
    }
    /// Of a closed manifold shell: the number of its handles.
    std::int64_t genus() const { return 1 - euler_characteristic() / 2; }
    friend bool operator==(const Shell&, const Shell&) = default;
  };
  std::vector<Shell> shells;
};

/// An edge without a twin counts once for each of its triangles.
Shells find_shells(std::span<const Triangle> triangles, std::span<const HalfEdge> twin, std::size_t vertex_count);

/// Each edge once, smaller vertex first, sorted.
std::vector<Edge> edges_of(std::span<const Triangle> triangles);

}  // namespace octafront
