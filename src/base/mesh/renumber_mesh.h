#pragma once

#include <octafront/tet_mesh.h>

#include "base/core/renumber.h"

#include <cstddef>
#include <vector>

namespace octafront {

/// Replaces the nodes that wedges, pyramids, quadrilaterals, doubled faces and pairs name by themselves. Doubled faces
/// and pairs with a node whose number is kNone go.
void renumber_named_nodes(TetMesh& mesh, const std::vector<VertexIndex>& number);

/// Replaces the corners and nodes of tetrahedra, faces and edges alone. REQUIRES: each has a number.
void renumber_corners(TetMesh& mesh, const std::vector<VertexIndex>& number);

/// Replaces each vertex in all arrays of a mesh but `points`; vertices whose number is kNone leave the sets of nodes.
void renumber_vertices(TetMesh& mesh, const std::vector<VertexIndex>& number);

/// Points that no tetrahedron uses go; the first `kept` stay where they are, used or not.
void drop_unused_points(TetMesh& mesh, std::size_t kept = 0);

}  // namespace octafront
