#pragma once

#include <octafront/tet_mesh.h>

#include "base/geometry/quadratic_tet.h"

#include <algorithm>

namespace octafront {

/// The edge (0 to 5) of a tet between two vertices; 6 if it has not both.
inline std::size_t edge_between(const Tet& t, VertexIndex a, VertexIndex b) {
  const auto is_it = [&](const auto& e) {
    const VertexIndex p = t[static_cast<std::size_t>(e[0])], q = t[static_cast<std::size_t>(e[1])];
    return (p == a && q == b) || (p == b && q == a);
  };
  return static_cast<std::size_t>(std::find_if(kTetEdges.begin(), kTetEdges.end(), is_it) - kTetEdges.begin());
}

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
