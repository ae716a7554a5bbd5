#pragma once

#include <octafront/size_field.h>
#include <octafront/surface_mesh.h>

#include "lattice/lattice_octree.h"

#include <cstdint>
#include <vector>

namespace octafront {

/// Per leaf: 1 if a ball of `clearance` times the size about some triangle can reach into it; everything in other
/// leaves is farther from the surface than that.
std::vector<std::uint8_t> near_leaves(const LatticeOctree& lattice, const SurfaceMesh& surface, const SizeField& sizes,
                                      double clearance);

}  // namespace octafront
