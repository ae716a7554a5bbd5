#pragma once

#include <octafront/tet_mesh.h>

#include "base/geometry/quadratic_tet.h"

#include <algorithm>
#include <array>
#include <span>

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

/// The nodes of an element of any order, those of tet_lattice(mesh.order()); `room` has place for them.
inline std::span<const Vec3> nodes_of_tet(const TetMesh& mesh, TetIndex t, std::array<Vec3, 35>& room) {
  const std::size_t each = mesh.high_nodes_per_tet();
  for (std::size_t i = 0; i < 4; ++i) room[i] = mesh.points[mesh.tets[t][i]];
  if (mesh.is_second_order())
    for (std::size_t e = 0; e < 6; ++e) room[4 + e] = mesh.points[mesh.mid_nodes[t][e]];
  for (std::size_t k = 0; k < each; ++k) room[4 + k] = mesh.points[mesh.high_nodes[t * each + k]];
  return {room.data(), mesh.is_second_order() ? 10 : 4 + each};
}

}  // namespace octafront
