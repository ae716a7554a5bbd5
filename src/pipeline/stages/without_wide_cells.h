#pragma once

#include <octafront/tet_mesh.h>

#include <vector>

namespace octafront {

/// The tetrahedra of a linear mesh that are part of no wedge or pyramid, as a mesh of their own; and the mesh that
/// they and the wedges and pyramids make up again. Refers to the mesh, which has no groups.
class WithoutWideCells {
 public:
  explicit WithoutWideCells(const TetMesh& mesh);

  /// Its boundary is numbered first. Faces between it and wedges or pyramids are a patch behind all.
  TetMesh inner() const;
  /// `inner` is what inner() was, with other points and tetrahedra inside, and the same boundary. Wedges and pyramids,
  /// their nodes, the boundary of the mesh and its quadrilaterals are what they were; vertices that are gone leave no
  /// gaps.
  TetMesh joined(TetMesh inner) const;

 private:
  void number_vertices();
  std::vector<Triangle> walls() const;

  const TetMesh& mesh_;
  std::vector<bool> is_wide_;          ///< per tetrahedron
  std::vector<Triangle> own_walls_;    ///< faces of one tetrahedron of inner(), in the numbers of the mesh
  std::vector<VertexIndex> fixed_;     ///< vertices of own_walls_, ascending
  std::vector<VertexIndex> in_inner_;  ///< per vertex of the mesh; kNone: not there
};

}  // namespace octafront
