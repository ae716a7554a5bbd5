#pragma once

// classic: the advancing front as it was before the octree, for comparison and as a method of its own. Takes a clean
// surface; sizes come from the surface's own edges, searches from alternating digital trees, and a new tetrahedron must
// pass all tests of the classical method. Leaves a mesh on exactly that surface, closed by the same steps as the other
// front.
//
//   surface_sizes, classic_front (alternating_tree) -> classic_attempt, smallest face first -> volume/ladder

#include <octafront/options.h>
#include <octafront/surface_mesh.h>
#include <octafront/tet_mesh.h>

#include "core/stage.h"

namespace octafront {

/// Fills a clean surface as fill_volume does (see there for what the result keeps). Of `options` only the distance of
/// the ideal point is used, and what the closing of cavities uses. Throws MeshingError if a cavity stays open.
TetMesh fill_volume_classic(const SurfaceMesh& surface, const VolumeOptions& options, const Stage& stage);

}  // namespace octafront
