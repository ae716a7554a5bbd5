#pragma once

// Vertices of walls moved a little off the ground, so that a mesh that is coarser than the ground encloses as much.

#include "adapt/passes/metric_passes.h"
#include "adapt/passes/piece.h"

#include <cstddef>

namespace octafront::adapt {

/// Moves the vertices inside walls by steps_to_balance(), as far as all elements keep being good. How many moved. Walls
/// that lie on a surface that was given stay.
std::size_t balance_walls(Parts& parts, const Guide& guide, double feature_angle);

}  // namespace octafront::adapt
