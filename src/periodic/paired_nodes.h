#pragma once

// Which nodes of a mesh are copies of which (TetMesh::periodic_nodes), and copies where their originals lead.

#include <octafront/error.h>
#include <octafront/tet_mesh.h>

#include "periodic/periodic_cell.h"

#include <cstdint>
#include <vector>

namespace octafront {

/// Opposite faces of a cell did not become the same.
class FacesDiffer : public MeshingError {
 public:
  using MeshingError::MeshingError;
};

/// Leaves the periods of the cell in a mesh of it, and pairs of all nodes on its faces. Throws FacesDiffer if the
/// boundary faces of opposite faces are not the same, or a copy does not lie where its original leads, bit for bit.
void pair_nodes_on_faces(const PeriodicCell& cell, TetMesh& mesh);

/// Of a mesh of order 2 to 4 of the cell: nodes behind corners on its faces lie in these, and copies where their
/// originals lead. Where an element is not valid with the nodes in their places, those of it that are paired become
/// straight, and what is a copy of them. Leaves the periods of the cell in the mesh. Returns how many nodes became
/// straight.
std::uint64_t bring_copies_behind_corners(const PeriodicCell& cell, TetMesh& mesh);

/// The same by the mesh's pairs of corners; the nodes become pairs, too.
void pair_nodes_behind_corners(TetMesh& mesh);

/// The corners of elements that are copies or have some, ascending.
std::vector<VertexIndex> paired_vertices(const TetMesh& mesh);

}  // namespace octafront
