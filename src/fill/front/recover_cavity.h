#pragma once

#include <octafront/run_context.h>
#include <octafront/surface_mesh.h>

#include "fill/front/excavation.h"

namespace octafront {

/// The outward surface of a cavity, its vertices in the order in which the walls name them; `global` receives their
/// numbers in the mesh.
SurfaceMesh surface_of(const WorkMesh& mesh, const std::vector<Wall>& walls, std::vector<VertexIndex>& global);

/// The last rung: takes `rings` of tetrahedra out around a cavity and fills it by a Delaunay mesh with its walls
/// recovered exactly. True if that closed it; otherwise nothing has changed.
bool close_by_recovery(const OpenCavity& cavity, int rings, const RunContext& context);

}  // namespace octafront
