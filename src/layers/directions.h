#pragma once

#include "layers/columns.h"
#include "layers/layered_walls.h"

#include <vector>

namespace octafront::layers {

/// The way that layers grow from each vertex of a wall.
struct Directions {
  std::vector<Vec3> step;      ///< for a height of 1; zero where there is none
  std::vector<Reason> reason;  ///< why there is none
};

/// Per vertex the direction whose largest angle to the normals there is least, smoothed over `passes` sweeps as far as
/// it still sees all triangles nearly as well. Where a wall ends at flat patches without layers, it lies in their
/// planes. Layers as thick as asked on flat faces need longer ways in corners: at most kMostStretch times.
Directions choose_directions(const Walls& walls, int passes);
inline constexpr double kMostStretch = 1.8;

}  // namespace octafront::layers
