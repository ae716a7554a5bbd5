#pragma once

#include "images/nets/given_surfaces.h"
#include "images/nets/net.h"

#include <cstdint>
#include <span>
#include <vector>

namespace octafront::nets {

/// Vertices that were put on surfaces; empty without surfaces.
struct PlacedVertices {
  std::vector<std::uint8_t> is_placed;  ///< per vertex
  std::vector<std::uint16_t> on;        ///< per vertex that is placed, the number of its surface
  std::vector<std::uint64_t> far;       ///< per surface: vertices that stay where they are, a voxel off and more
};

/// Puts the vertices between what a surface holds and what is around on it, within their cells, where they are no
/// farther than a voxel from it; of several surfaces on the nearest one.
PlacedVertices place_on_surfaces(const Net& net, const Lattice& lattice, std::span<const GivenSurface> surfaces,
                                 std::vector<Vec3>& x, const RunContext& context);

/// How far vertices lie from their surface at last.
struct Deviation {
  std::uint64_t vertices = 0;
  double sum = 0, largest = 0;
};
std::vector<Deviation> deviations(std::span<const GivenSurface> surfaces, const PlacedVertices& placed,
                                  std::span<const Vec3> world);

}  // namespace octafront::nets
