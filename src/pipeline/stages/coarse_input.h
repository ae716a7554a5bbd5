#pragma once

// Images have a triangle for each face of a voxel: far more than sizes need that are much coarser.

#include <octafront/domain.h>

#include "pipeline/stages/run.h"

#include <optional>

namespace octafront {

/// The domain of an image with triangles about half as large as the sizes that are asked for, so that sizes, trees and
/// the surface front do not work on more; nothing where they are hardly larger than voxels, where sizes are measured on
/// the surface, or where its triangles must stay.
std::optional<Domain> coarse_domain(const Domain& domain, Run& run);

}  // namespace octafront
