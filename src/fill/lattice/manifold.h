#pragma once

#include <octafront/run_context.h>
#include <octafront/tet_mesh.h>

#include <cstddef>

namespace octafront {

/// Makes the boundary a closed 2-manifold: where parts of the mesh touch in no more than an edge or a point, the
/// smaller ones lose the tetrahedra at that place. Boundary faces are found anew and unused points dropped; `mesh` must
/// have no fields but points, tets and boundary. Returns how many tetrahedra went. Always ends.
std::size_t make_boundary_manifold(TetMesh& mesh, const RunContext& context);

}  // namespace octafront
