#pragma once

#include <octafront/tet_mesh.h>

#include "base/geometry/quadratic_tet.h"

namespace octafront {

/// The ten nodes of an element; those of a linear mesh lie in the middle of its edges.
inline QuadraticTet quadratic_nodes(const TetMesh& mesh, TetIndex t) {
  QuadraticTet nodes;
  for (std::size_t i = 0; i < 4; ++i) nodes[i] = mesh.points[mesh.tets[t][i]];
  for (std::size_t e = 0; e < 6; ++e)
    nodes[4 + e] = mesh.is_second_order() ? mesh.points[mesh.mid_nodes[t][e]]
                                          : 0.5 * (nodes[static_cast<std::size_t>(kTetEdges[e][0])] +
                                                   nodes[static_cast<std::size_t>(kTetEdges[e][1])]);
  return nodes;
}

}  // namespace octafront
