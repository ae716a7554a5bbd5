#pragma once

#include <octafront/surface_mesh.h>

#include "base/mesh/known_surface.h"

#include <cstdint>
#include <vector>

namespace octafront {

/// Per vertex the way along its normal, so that triangles lie as near to the input as vertices off it let them, by
/// least squares: chords of what is bent lie half outside then. `moves`: per vertex, whether it may; others get none.
/// What lies nearest must bound the same regions, within half an edge.
std::vector<Vec3> moves_to_fit(const SurfaceMesh& surface, const std::vector<std::uint8_t>& moves,
                               const KnownSurface& input);

}  // namespace octafront
