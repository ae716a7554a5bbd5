#pragma once

// Images have a triangle for each face of a voxel, and scans one for each few points: far more than sizes need that are
// much coarser.

#include <octafront/domain.h>
#include <octafront/surface_mesh.h>

#include "pipeline/stages/run.h"

#include <optional>

namespace octafront {

/// The domain of an image with triangles about half as large as the sizes that are asked for, so that sizes, trees and
/// the surface front do not work on more; nothing where they are hardly larger than voxels, where sizes are measured on
/// the surface, or where its triangles must stay.
std::optional<Domain> coarse_domain(const Domain& domain, Run& run);

/// The surface of one body likewise, if it has very many triangles, much smaller than automatic sizes, the size or the
/// number of elements that is given, and the user bounds nowhere how far the new surface may stray: within a twentieth
/// of its mean edge. Not where walls or gaps are about as narrow as that. REQUIRES a clean surface.
std::optional<SurfaceMesh> coarse_surface(const SurfaceMesh& clean, Run& run);

}  // namespace octafront
