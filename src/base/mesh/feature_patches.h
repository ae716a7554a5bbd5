#pragma once

#include "base/mesh/features.h"

namespace octafront {

struct SurfaceMesh;

/// Gives each part of the surface that feature edges and patch borders enclose a patch of its own, counted in the order
/// of the first triangle. Parts of a named patch keep its name; where there are several, "name.1", "name.2" ...
/// Returns the number of patches.
std::uint32_t divide_into_patches(SurfaceMesh& surface, const EdgeTable& edges, const Features& features);

}  // namespace octafront
