#pragma once

#include <octafront/surface_mesh.h>
#include <octafront/tet_mesh.h>

#include "layers/region_walls.h"

#include <vector>

namespace octafront::layers {

/// A surface whose regions end at the tops of their layers; between these and the walls is nothing.
struct Opened {
  SurfaceMesh surface;
  /// Per layered region and vertex of its wall: the vertex of `surface` that is its top. A vertex of the whole surface
  /// keeps its number unless nothing needs it below the layers: then its top has it.
  std::vector<std::vector<VertexIndex>> top;
};

/// What the volume front fills. Layers outside leave it as it is.
Opened without_layers(const SurfaceMesh& whole, const std::vector<LayeredRegion>& grown);

/// A mesh with its layers, and what it must have as its boundary and interfaces.
struct Layered {
  TetMesh mesh;
  SurfaceMesh boundary;
  SurfaceMesh ground;              ///< the whole surface as it is in the mesh: the boundary, but for tops of layers
  std::vector<VertexIndex> below;  ///< per vertex of the mesh: the one of a wall that it lies over, or itself
};

/// Adds the layers to a mesh of `opened.surface`, whose vertices come first in it. The vertices of the whole surface
/// keep their numbers; patches and sources are those of its triangles. What lies beside the layers on patches without
/// belongs to these patches. The layers of each region are a region of their own, behind all others: "layers", or
/// "fluid layers" where there are several regions; there their tops are interfaces too.
Layered with_layers(const SurfaceMesh& whole, const std::vector<LayeredRegion>& grown, const Opened& opened,
                    TetMesh inner);

}  // namespace octafront::layers
