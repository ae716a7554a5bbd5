#pragma once

#include <octafront/surface_mesh.h>
#include <octafront/tet_mesh.h>

#include "layers/columns/columns.h"

namespace octafront::layers {

/// The surface on top of the layers: the same triangles, the vertices of columns moved to their tops.
SurfaceMesh top_of(const SurfaceMesh& wall, const Columns& columns);

/// A mesh with its layers, and what it must have as its boundary.
struct Layered {
  TetMesh mesh;
  SurfaceMesh boundary;
};

/// Adds the layers to a mesh of what is inside top_of(): its boundary triangles, patches and sources are those of
/// `wall`, its vertices come first. The vertices of the wall keep their numbers. What lies beside the layers on patches
/// without belongs to these patches. The layers are a region of their own, the last one, called "layers".
Layered with_layers(const SurfaceMesh& wall, const Columns& columns, TetMesh inner);

}  // namespace octafront::layers
