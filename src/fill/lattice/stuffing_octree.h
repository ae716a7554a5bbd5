#pragma once

#include <octafront/run_context.h>
#include <octafront/size_field.h>

#include "fill/lattice/implicit_domain.h"
#include "fill/lattice/lattice_octree.h"

namespace octafront {

struct SurfaceMesh;

/// The octree below a stuffed lattice: leaves of the wanted size inside the body, and at least one leaf of that size
/// beyond it all around, so that where sizes are uniform the boundary runs through leaves of one size only, and nowhere
/// near the wall of the root. Farther outside leaves stay coarse.
LatticeOctree build_stuffing_octree(const SurfaceMesh& surface, const SurfaceDomain& domain, const SizeField& sizes,
                                    const RunContext& context);

}  // namespace octafront
