#pragma once

#include <octafront/options.h>
#include <octafront/tet_mesh.h>

#include "base/core/stage.h"

namespace octafront {

struct SurfaceMesh;

/// Fills a clean surface as fill_volume does (see there for what the result keeps). Of `options` only the distance of
/// the ideal point is used, and what the closing of cavities uses. Throws MeshingError if a cavity stays open.
TetMesh fill_volume_classic(const SurfaceMesh& surface, const VolumeOptions& options, const Stage& stage);

}  // namespace octafront
