#pragma once

// layers/growth: how high boundary layers may become on a surface. Takes a clean surface, the triangles that are walls
// and what is asked of their layers; leaves columns whose tetrahedra are positive, whose tops neither meet each other
// nor a wall, so that the inside can be meshed like any other body.

#include "base/core/stage.h"
#include "layers/columns/columns.h"

#include <cstdint>
#include <vector>

namespace octafront::layers {

/// What is asked of the layers of a wall.
struct Asked {
  std::uint32_t count = 0;    ///< layers
  double growth = 1.2;        ///< each over the one below
  std::vector<double> first;  ///< per vertex of the surface: height of the first layer, > 0 on walls
  double over_size = 0;       ///< total height over the edge lengths there, about
};

/// Grows columns from the triangles that are walls, as high as they can be. Nothing is made worse than it must: where
/// layers cannot be, they are thinner or fewer, down to none.
Columns grow(const SurfaceMesh& surface, std::vector<std::uint8_t> is_wall, const Asked& asked, const Stage& stage);

}  // namespace octafront::layers
