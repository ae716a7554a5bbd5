#pragma once

#include <octafront/vec.h>

#include "soup/tidy/steps.h"

#include <cstdint>
#include <vector>

namespace octafront::mend {

struct LaidFlat {
  std::uint64_t faces = 0;  ///< taken away
  double largest_move = 0;
  std::vector<Vec3> places;
};

/// Where a sheet crosses nothing but itself, and all that within the tolerance, its faces there give way to those over
/// their rim that bend least: folds that crossed would stay as layers with clefts between them, which no element fits.
/// Only discs are taken, whose caps lie within the tolerance of them, both ways, and cross nothing. Requires that
/// neighbouring triangles agree.
LaidFlat lay_crumples_flat(tidy::Draft& draft, double tolerance);

}  // namespace octafront::mend
