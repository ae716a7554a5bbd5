#pragma once

// How far the walls of a mesh may stray where nothing is said: small bodies in large domains by their own size.

#include <octafront/options.h>
#include <octafront/tet_mesh.h>

#include "adapt/schedule/adapt_mesh.h"

#include <vector>

namespace octafront {

/// Adds sets of faces to the mesh, for as long as it is adapted, that may stray less than `tolerance`, which is for
/// walls as large as `diagonal`: those of connected pieces that are less than half, a quarter, ... of that. Where
/// options.surface.max_deviation is given none are.
std::vector<adapt::ToleranceOfSet> add_wall_sizes(TetMesh& mesh, const Options& options, double tolerance,
                                                  double diagonal);

}  // namespace octafront
