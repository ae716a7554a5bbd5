#pragma once

#include <octafront/complex.h>
#include <octafront/image.h>
#include <octafront/run_context.h>

#include "images/formulas/formulas.h"

namespace octafront {

/// complex_of_bands() of what is below 0, one region "body", with vertices where the function is 0. `image` has its
/// values at the middles of the voxels; its axes are those of the world.
Complex complex_of_function(const Image& image, const formulas::SpaceFunction& function, const RunContext& context);

}  // namespace octafront
