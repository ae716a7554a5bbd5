#pragma once

#include <octafront/tet_mesh.h>

#include "base/core/stage.h"
#include "base/mesh/features.h"

namespace octafront {

struct SurfaceMesh;

/// Moves vertices inside the patches of interfaces along the input's patch, where that makes the worst element around
/// them better, for some sweeps; those of curves and of the boundary stay. No element is inverted (exact signs), so no
/// region leaks. `filled`: the complex that the mesh fills, whose vertices are the mesh's first ones; `features`: of
/// it; `input`: the complex that it stands for, with the same patches. Returns the number of moves.
std::uint64_t slide_interfaces(TetMesh& mesh, const SurfaceMesh& filled, const Features& features,
                               const SurfaceMesh& input, const Stage& stage);

}  // namespace octafront
