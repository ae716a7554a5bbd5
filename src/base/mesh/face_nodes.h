#pragma once

#include <octafront/tet_mesh.h>

#include "base/mesh/tet_edges.h"

#include <array>
#include <vector>

namespace octafront {

/// The nodes of the faces of a mesh of order 2 to 4, those of an element that has them.
class FaceNodes {
 public:
  using Weights = std::array<int, 3>;

  /// The mesh must outlive this.
  explicit FaceNodes(const TetMesh& mesh);

  bool has(const Triangle& face) const;
  /// The node of a face whose barycentric coordinates are these over the order, in the order of its corners.
  VertexIndex node(const Triangle& face, const Weights& weights) const;

 private:
  const TetMesh& mesh_;
  TetFaces faces_;
  std::vector<TetIndex> side_;  ///< per face an element that has it
};

/// visit(weights) for each node of a face but its corners.
template <class Visit>
void visit_nodes_behind_corners(int order, const Visit& visit) {
  for (int i = 0; i <= order; ++i)
    for (int j = 0; i + j <= order; ++j)
      if (const int k = order - i - j; i < order && j < order && k < order) visit(FaceNodes::Weights{i, j, k});
}

}  // namespace octafront
