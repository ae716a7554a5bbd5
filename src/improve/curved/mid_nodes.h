#pragma once

#include <octafront/tet_mesh.h>

#include "base/mesh/tet_edges.h"

namespace octafront::curved {

/// Gives a linear mesh straight mid-side nodes: the one of edge e is points[corners + e].
TetEdges add_straight_mid_nodes(TetMesh& mesh);

}  // namespace octafront::curved
