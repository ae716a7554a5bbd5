#pragma once

#include <octafront/ids.h>
#include <octafront/vec.h>

#include "soup/arrangement/arrange.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace octafront::arrangement {

/// Triangles on their way, each with its origins in the input.
struct Soup {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
  std::vector<std::vector<Origin>> origins;
};

/// Brings together what nearly meets among the triangles of `pairs`: vertices nearer to each other than `reach` become
/// the first of them; edges and faces go through vertices that are nearer to them than that (they are divided there,
/// with all triangles at an edge). Triangles may lose their area. Returns the farthest that a vertex went; what is
/// divided moves by `reach` at most. Cost: O(n log n).
double snap(Soup& soup, std::span<const std::array<std::uint32_t, 2>> pairs, double reach);

}  // namespace octafront::arrangement
