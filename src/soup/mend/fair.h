#pragma once

#include "soup/mend/cap.h"

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace octafront::mend {

/// A corner of the polygon, and a point of the surface beyond it that an edge joins it with.
using Spoke = std::pair<std::uint32_t, Vec3>;

/// A cap with points of its own: numbers from the polygon's size on are those of `inner`.
struct FairCap {
  Cap triangles;
  std::vector<Vec3> inner;
};

/// Divides a cap's triangles until they are as large as the edges of the rim near them, then bends it so that it goes
/// on as the surface around it begins (refinement and fairing after P. Liepa, "Filling Holes in Meshes", 2003: the
/// least sum of squares of the umbrella operator, with the rim and what is beyond it fixed). Where more than `most`
/// points would be added, triangles grow away from the rim. No edge that `is_taken` is made. Cost: for n points some
/// 100 ns times n^1.5.
FairCap faired(std::span<const Vec3> polygon, const Cap& cap, std::span<const Spoke> beyond, const IsTaken& is_taken,
               std::size_t most);

}  // namespace octafront::mend
