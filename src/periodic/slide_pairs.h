#pragma once

#include <octafront/tet_mesh.h>

#include "base/core/stage.h"
#include "periodic/periodic_cell.h"

namespace octafront {

struct SurfaceMesh;

/// Moves vertices inside flat periodic faces within their plane, each together with its copy, where that makes the
/// elements around both better on average and none of the poor ones worse; those on lines of faces stay. No element is
/// inverted (exact signs), and copies stay copies, bit for bit. `filled`: the surface or complex that the mesh fills,
/// whose vertices are the mesh's first ones. Returns the number of moves.
std::uint64_t slide_pairs(TetMesh& mesh, const SurfaceMesh& filled, const PeriodicCell& cell, const Stage& stage);

}  // namespace octafront
