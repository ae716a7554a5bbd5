#pragma once

#include <octafront/ids.h>

#include "base/mesh/edge_table.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace octafront {

/// For each half-edge the one that runs the other way on the same edge, twin[twin[h]] = h; kNone where the edge does
/// not have exactly two triangles that run through it in opposite directions. Requires vertex indices in range.
std::vector<HalfEdge> half_edge_twins(std::span<const Triangle> triangles, std::size_t vertex_count);
std::vector<HalfEdge> half_edge_twins(std::span<const Triangle> triangles, const EdgeTable& edges);

/// True if each edge has exactly two triangles, in opposite directions, and the triangles around each vertex form one
/// fan; no triangle has a vertex twice. (Vertices without triangles do not matter.)
bool is_closed_manifold(std::span<const Triangle> triangles, std::size_t vertex_count);

/// Vertices whose triangles form more than one fan, ascending. `twin` as above; requires a surface whose edges all have
/// twins.
std::vector<VertexIndex> pinched_vertices(std::span<const Triangle> triangles, std::span<const HalfEdge> twin,
                                          std::size_t vertex_count);

/// Whether triangles of all edges with two run through them in opposite directions, and no edge has more. `closed`: and
/// none fewer.
bool is_turned_one_way(std::span<const Triangle> triangles, const EdgeTable& edges, bool closed);

/// Across which edges triangles hang together around a vertex.
enum class FansOver { kEdgesOfTwo, kAllEdges };
/// Per vertex 1 if its triangles form several fans there, or if one of its edges joins none of them. Their number at an
/// edge and the way they are turned do not matter.
std::vector<std::uint8_t> touching_vertices(std::span<const Triangle> triangles, const EdgeTable& edges,
                                            std::size_t vertex_count, FansOver over);

}  // namespace octafront
