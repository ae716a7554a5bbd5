#pragma once

// The nodes of elements of order 3 and 4, and of their faces and edges, in the order of VTK's Lagrange cells.

#include <octafront/tet_mesh.h>

#include "base/core/groups.h"

#include <cstddef>
#include <cstdint>

namespace octafront::io {

struct Side;

class HighNodes {
 public:
  /// Of a mesh of a lower order nothing may be asked.
  explicit HighNodes(const TetMesh& mesh);

  VertexIndex of_tet(std::size_t t, std::size_t k) const;
  /// Of a face, as its corners run, of the element beside it.
  VertexIndex of_face(const Side& side, const Triangle& corners, std::size_t k) const;
  /// Of an edge of a curve.
  VertexIndex of_edge(const Edge& edge, std::size_t k) const;

 private:
  struct Use {
    VertexIndex high;
    TetIndex tet;
  };
  /// The node of an element that has these weights.
  template <std::size_t kCorners>
  VertexIndex node(TetIndex t, const std::array<VertexIndex, kCorners>& corners,
                   const std::array<int, kCorners>& weights) const;

  const TetMesh& mesh_;
  Groups<Use, std::uint64_t> at_low_;  ///< edges between vertices of curves, at their lower ends
};

/// Node k of a cell of VTK of order 3 or 4 among those of tet_lattice(); of Gmsh among those of VTK.
std::size_t lattice_node_of_vtk(int order, std::size_t k);
std::size_t lattice_node_of_gmsh(int order, std::size_t k);
std::size_t vtk_node_of_gmsh(int order, std::size_t k);

}  // namespace octafront::io
