#pragma once

#include <octafront/tet_mesh.h>

#include "base/geometry/triangle_tree.h"

namespace octafront {

struct SurfaceMesh;

/// After improvement has moved the boundary: each triangle of the mesh that is no longer the one of `before` gets as
/// its source that of the triangle of the `input` that is nearest now, found by the `tree` over it. `before`: the
/// boundary as it was, in the same order.
void renew_sources(TetMesh& mesh, const SurfaceMesh& before, const SurfaceMesh& input, const TriangleTree& tree);

/// What was filled follows what became of its boundary and interfaces, whose vertices come first in the mesh; of
/// a complex whose patches have one pair of sides each.
void follow_boundary(const TetMesh& mesh, SurfaceMesh& filled);

}  // namespace octafront
