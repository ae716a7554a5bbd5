#pragma once

#include <octafront/tet_mesh.h>

#include "base/core/stage.h"
#include "fill/lattice/implicit_domain.h"
#include "sizing/field/octree.h"

namespace octafront {

/// Cut points nearer to a lattice point than these parts of their edge pull it onto the boundary (Labelle & Shewchuk
/// 2007, section 2: with them all dihedral angles lie between 10.7 and 164.8 degrees on a uniform lattice).
inline constexpr double kWarpLong = 0.24999, kWarpShort = 0.41189;

/// Isosurface stuffing: the tetrahedra of the lattice on `tree` inside `domain`, lattice points near its boundary moved
/// onto it, tetrahedra that still cross it cut. All are positive. `boundary` is filled, the rest of the mesh's fields
/// are left empty. Counts in `report` what was warped and cut.
/// REQUIRES: the tree is balanced, and the domain keeps at least two leaves away from the wall of the root.
TetMesh cut_lattice(const RootCube& root, const Octree& tree, const ImplicitDomain& domain, const Stage& stage);

}  // namespace octafront
