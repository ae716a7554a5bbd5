#pragma once

// What the faces of a cell are called, and their patches.

#include <octafront/surface_mesh.h>
#include <octafront/tet_mesh.h>

#include "periodic/periodic_cell.h"

#include <string>

namespace octafront {

/// "x_min", "x_max", ... of a box; else "periodic_1_low", ...
std::string name_of_face(const PeriodicCell& cell, CellFace face);

/// Each face of the cell gets patches of its own, and each of these one copy.
void name_faces(SurfaceMesh& surface, const PeriodicCell& cell);

/// Patches that name_faces() made of one face become one again.
void unite_patches(const PeriodicCell& cell, TetMesh& mesh);

}  // namespace octafront
