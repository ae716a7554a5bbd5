#pragma once

// The nodes of curved tetrahedra as MFEM has them: how they are numbered, and where they lie.

#include <octafront/tet_mesh.h>

#include "formats/parts/tet_parts.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace octafront::io {

/// The numbers of the nodes of MFEM's continuous space (H1) of order 1 to 4, as MFEM counts when it reads a mesh:
/// vertices; those inside edges, edges in the order in which elements name them (kTetEdges), from the lower vertex to
/// the higher; those inside faces, likewise (kTetFaces), at order 4 by the corners that they are nearest to, as the
/// first element names them; those inside elements. 40 bytes per element.
class MfemNumbering {
 public:
  /// Keeps `tets`, whose indices are below `vertices`.
  MfemNumbering(std::span<const Tet> tets, std::size_t vertices, int order);

  std::size_t size() const { return size_; }
  /// Those of an element in the order of tet_lattice().
  void of_tet(TetIndex t, std::span<VertexIndex> nodes) const;

 private:
  VertexIndex in_edge(TetIndex t, std::size_t edge, std::size_t k) const;
  VertexIndex in_face(TetIndex t, std::size_t face, std::size_t k) const;

  std::span<const Tet> tets_;
  std::size_t vertices_, in_edges_ = 0, in_faces_ = 0;  ///< where the numbers of nodes in edges and faces end
  int order_;
  std::size_t size_;
  NumberedParts edges_, faces_;
};

/// Kinds of nodes in one direction, by MFEM's letters.
enum class MfemPoints : char { kGaussLegendre = 'g', kGaussLobatto = 'G', kBernstein = 'P', kUniform = 'U' };

/// What leads from the nodes of an element of that kind and order to those of ours, both in the order of
/// tet_lattice(): rows of a square matrix; empty: they are the same.
std::vector<double> matrix_from_mfem(MfemPoints points, int order);

}  // namespace octafront::io
