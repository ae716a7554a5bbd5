#pragma once

#include <octafront/ids.h>

#include "base/mesh/edge_table.h"

#include <cstddef>
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

}  // namespace octafront
