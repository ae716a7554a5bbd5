#pragma once

#include <octafront/run_context.h>

#include "images/nets/cells.h"
#include "images/nets/stencils.h"

#include <vector>

namespace octafront::nets {

/// Moves the vertices such that the sum of squared second differences becomes least, each within its cell: surfaces
/// that bend evenly, without the steps of the voxels. Curves count by their own neighbours, and follow the surfaces
/// that end at them through theirs. `x`: where the vertices are and will be, straight space.
///
/// Projected gradient with Nesterov's momentum (A. Beck, M. Teboulle, "A Fast Iterative Shrinkage-Thresholding
/// Algorithm for Linear Inverse Problems", 2009).
void fair(const Stencils& stencils, const VertexCells& cells, std::vector<Vec3>& x, const RunContext& context);

}  // namespace octafront::nets
