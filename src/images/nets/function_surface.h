#pragma once

#include <octafront/complex.h>
#include <octafront/image.h>
#include <octafront/run_context.h>

#include "images/formulas/formulas.h"

namespace octafront {

/// complex_of_bands() of what is below 0, one region "body", with vertices where the function is 0. `image` has its
/// values at the middles of the voxels; its axes are those of the world. `needed`: no more is looked at than what
/// changes something in this box; what is outside may be coarse. Empty: all is needed.
Complex complex_of_function(const Image& image, const formulas::SpaceFunction& function, const RunContext& context,
                            const Box3& needed = {});

}  // namespace octafront
