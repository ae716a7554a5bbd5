#pragma once

#include <octafront/tet_mesh.h>
#include <octafront/vec.h>

#include "base/core/parallel.h"

#include <cstddef>
#include <vector>

namespace octafront {

/// Keeps the points v with number[v] != kNone, in their order. On return number[v] is where point v went.
void keep_numbered(std::vector<Vec3>& points, std::vector<VertexIndex>& number);

/// Replaces each vertex of the rows (triangles, tets, edges) by its new number.
template <class Rows>
void renumber(Rows& rows, const std::vector<VertexIndex>& number) {
  parallel_for(rows.size(), [&](std::size_t i) {
    for (VertexIndex& v : rows[i]) v = number[v];
  });
}

/// Replaces the nodes that wedges, pyramids, quadrilaterals, doubled faces and pairs name by themselves. Doubled faces
/// and pairs with a node whose number is kNone go.
void renumber_named_nodes(TetMesh& mesh, const std::vector<VertexIndex>& number);

/// Replaces each vertex in all arrays of a mesh but `points`; vertices whose number is kNone leave the sets of nodes.
void renumber_vertices(TetMesh& mesh, const std::vector<VertexIndex>& number);

/// Points that no tetrahedron uses go; the first `kept` stay where they are, used or not.
void drop_unused_points(TetMesh& mesh, std::size_t kept = 0);
/// Points that no triangle uses go.
void drop_unused_points(std::vector<Vec3>& points, std::vector<Triangle>& triangles);

}  // namespace octafront
