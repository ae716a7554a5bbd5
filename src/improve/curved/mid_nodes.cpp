#include "improve/curved/mid_nodes.h"

#include "base/core/parallel.h"

namespace octafront::curved {

TetEdges add_straight_mid_nodes(TetMesh& mesh) {
  const std::size_t corners = mesh.points.size();
  TetEdges edges = edges_of_tets(mesh.tets, corners, mesh.mid_nodes);
  mesh.points.resize(corners + edges.size());
  parallel_for(edges.size(), [&](std::size_t e) {
    mesh.points[corners + e] = 0.5 * (mesh.points[edges.low[e]] + mesh.points[edges.high[e]]);
  });
  parallel_for(mesh.mid_nodes.size(), [&](std::size_t t) {
    for (VertexIndex& node : mesh.mid_nodes[t]) node += static_cast<VertexIndex>(corners);
  });
  return edges;
}

}  // namespace octafront::curved
