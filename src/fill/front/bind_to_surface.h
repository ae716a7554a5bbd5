#pragma once

#include <octafront/tet_mesh.h>

#include "base/shared/comm.h"

namespace octafront {

struct SurfaceMesh;

/// `mesh` fills `surface`, whose points come first: the surface's triangles and patches become its boundary (of a
/// complex, its boundary and interfaces), and its tetrahedra get their regions: those of the complex, or bodies (outer
/// shells with their cavities) numbered by their first triangle, none if there is only one. `comm`: of ranks that have
/// shares of the tetrahedra, not of a complex.
void bind_to_surface(TetMesh& mesh, const SurfaceMesh& surface, const Comm& comm = Comm(nullptr));

}  // namespace octafront
