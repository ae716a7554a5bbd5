#pragma once

#include <octafront/tet_mesh.h>

#include "fill/cavity/work_mesh.h"
#include "fill/front/front_task.h"

#include <vector>

namespace octafront {

/// Closes what the front has left open, rung by rung: backtracking with other choices and growing rings, a kernel point
/// with growth, and at last recovery of the cavity's walls in a Delaunay mesh. `mesh` fills `surface`, whose points
/// come first, but for what the walls enclose; they face it. Points that the closing leaves without a tetrahedron go.
/// What comes out hangs on no order, of tetrahedra or walls. Reports which rung closed how many. Throws OpenCavityError
/// with the first cavity that stays open, or has more walls than the surface has triangles: then recovery of the whole
/// surface is less work.
void close_cavities(TetMesh& mesh, std::vector<Wall> walls, const SurfaceMesh& surface, const FrontTask& task);

}  // namespace octafront
