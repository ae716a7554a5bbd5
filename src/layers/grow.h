#pragma once

// layers: how high boundary layers may become. Takes what bounds a region and what is asked of its layers;
// leaves columns whose tetrahedra are positive, whose tops neither meet each other nor a wall, so that the rest of the
// region can be meshed like any other body.

#include "base/core/stage.h"
#include "layers/columns.h"
#include "layers/region_walls.h"

#include <cstdint>
#include <vector>

namespace octafront::layers {

/// What is asked of the layers of a wall.
struct Asked {
  std::uint32_t count = 0;    ///< layers
  double growth = 1.2;        ///< each over the one below
  std::vector<double> first;  ///< per vertex of the wall: height of the first layer, > 0
  double over_size = 0;       ///< total height over the edge lengths there, about
};

/// Grows columns from the triangles of a region that are walls, as high as they can be. Nothing is made worse than it
/// must: where layers cannot be, they are thinner or fewer, down to none.
/// Vertices inside flat patches without layers make room for them: they move within these.
Columns grow(RegionWall& wall, const Asked& asked, const Stage& stage);

}  // namespace octafront::layers
