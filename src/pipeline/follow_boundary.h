#pragma once

#include <octafront/surface_mesh.h>
#include <octafront/tet_mesh.h>

#include "geometry/triangle_tree.h"

#include <cstdint>
#include <vector>

namespace octafront {

/// After improvement has moved the boundary: each triangle of the mesh that is no longer the one of `before` gets as
/// its source the face of the triangle of the input that is nearest now, found by the `tree` over it. `before`: the
/// boundary as it was, in the same order.
void renew_sources(TetMesh& mesh, const SurfaceMesh& before, const TriangleTree& tree,
                   const std::vector<std::uint32_t>& face_of_triangle);

}  // namespace octafront
