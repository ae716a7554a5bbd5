#pragma once

// Steps by which walls that were made anew stand for as much as the ground: where they are too coarse for a smooth
// surface through them, all their triangles lie to one side of it, and a loop of such meshes would wear the body.

#include "adapt/ground/ground.h"

#include <cstdint>
#include <span>
#include <vector>

namespace octafront::adapt {

/// Per point of walls of a mesh on the ground: the step along its normal such that as much lies between the ground and
/// what the walls stand for themselves (their own smooth surface, flat where there is none) on one side as on the
/// other, weighted by the point's share of places; zero where that is next to nothing. Points that may not move leave
/// their shares to the others of their triangles; those that may, but do not wait, are where they belong and stay.
/// `near`: per point a triangle of the ground that may be near, or kNone. `tolerance`: per part of the ground's walls,
/// which have the same numbers here; > 0.
std::vector<Vec3> steps_to_balance(const Walls& walls, std::span<const std::uint8_t> may_move,
                                   std::span<const std::uint8_t> waits, std::span<const std::uint32_t> near,
                                   const Ground& ground, std::span<const double> tolerance);

}  // namespace octafront::adapt
