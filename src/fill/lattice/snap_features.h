#pragma once

#include <octafront/size_field.h>
#include <octafront/tet_mesh.h>

#include "base/core/stage.h"
#include "base/geometry/triangle_tree.h"
#include "base/mesh/features.h"

namespace octafront {

struct SurfaceMesh;

/// Moves boundary vertices of a stuffed mesh onto the corners and feature curves of `surface` near them, wherever every
/// tetrahedron around the vertex stays positive (exactly) and of fair shape, and the boundary does not meet itself
/// (exactly). `triangles` is the tree over `surface`.
void snap_features(TetMesh& mesh, const SurfaceMesh& surface, const Features& features, const TriangleTree& triangles,
                   const SizeField& sizes, const Stage& stage);

}  // namespace octafront
