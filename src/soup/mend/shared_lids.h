#pragma once

#include <octafront/ids.h>
#include <octafront/vec.h>

#include "soup/mend/loops.h"

#include <cstdint>
#include <span>
#include <vector>

namespace octafront::mend {

/// Rims of which the first lies around the others, all in one plane within the tolerance, and the triangles that close
/// them together.
struct SharedLid {
  std::vector<std::uint32_t> loops;  ///< the outer one first
  std::vector<Triangle> cap;
};

/// Where a body with a channel is cut off, its lid has a hole: two lids that lie in each other within rounding would
/// leave membranes over the channel. Constrained Delaunay triangulations seen across the plane; only such that have the
/// rims as their border exactly. `may_share`: per loop.
std::vector<SharedLid> shared_lids(std::span<const Vec3> points, const std::vector<Loop>& loops,
                                   const std::vector<char>& may_share, double tolerance);

}  // namespace octafront::mend
