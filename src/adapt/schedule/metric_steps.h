#pragma once

// A metric of other directions is come to in steps: elements that lie across its directions would be divided without
// end.

#include "adapt/passes/metric_passes.h"
#include "adapt/passes/piece.h"

#include <cstddef>

namespace octafront::adapt {

/// Gives each vertex the metric of its place, or one on the way to it from what the mesh is like there, unless this is
/// the `last` step; how many are on the way. With `walls_ahead`, walls are divided first where the metric will find
/// them too long and too bent: as long as elements are not yet flat they can follow the ground as near as that.
std::size_t take_step(Parts& mesh, const Guide& guide, bool last, bool walls_ahead);

}  // namespace octafront::adapt
