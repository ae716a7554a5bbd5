#pragma once

#include <octafront/tet_mesh.h>

#include <vector>

namespace octafront {

/// Several meshes as one, part after part; corners come before mid-side nodes. Regions, patches, curves and sets of one
/// name become one; regions come behind those that `named` has names and numbers of. Requires meshes without periods,
/// all of one order.
TetMesh joined_meshes(std::vector<TetMesh> parts, TetMesh named);

}  // namespace octafront
