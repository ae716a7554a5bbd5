#pragma once

#include "layers/columns.h"
#include "layers/layered_walls.h"

#include <vector>

namespace octafront::layers {

/// How much of its asked height each column may have, and why not all of it.
struct Allowance {
  std::vector<double> part;    ///< per vertex, in [0, 1]
  std::vector<Reason> reason;  ///< of the last limit

  void limit(VertexIndex v, double most, Reason why) {
    if (!(most < part[v])) return;
    part[v] = most, reason[v] = why;
  }
};

/// Limits the columns of a wall to a part of the way to what lies opposite.
void limit_by_gaps(const Walls& walls, const Columns& columns, Allowance& allowed);

/// Gives the columns as many layers, and as high ones, as they are allowed: heights change no faster than along edges
/// of the wall and by no more than a factor of two from vertex to vertex; they are scaled down to a half, and layers
/// are left out beyond, at most half of them from vertex to vertex.
void settle_heights(const Walls& walls, Allowance& allowed, Columns& columns);

}  // namespace octafront::layers
