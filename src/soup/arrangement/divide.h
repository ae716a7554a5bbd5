#pragma once

#include <octafront/ids.h>
#include <octafront/run_context.h>

#include "soup/arrangement/arrange.h"
#include "soup/arrangement/contacts.h"

#include <span>
#include <vector>

namespace octafront::arrangement {

/// Triangles divided along what they have in common, on exact points.
struct Divided {
  std::vector<Triangle> triangles;  ///< of points of the table
  std::vector<std::vector<Origin>> origins;
};

/// Divides triangles by their conflicts `pairs`; what touches none comes out as it is. Adds points to the table; equal
/// points have one number in the result.
Divided divide(PointTable& table, std::span<const Triangle> triangles,
               std::span<const std::array<std::uint32_t, 2>> pairs, const RunContext& context);

}  // namespace octafront::arrangement
