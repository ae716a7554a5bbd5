#pragma once

#include <octafront/options.h>
#include <octafront/run_context.h>

#include "sizing/sources/wanted_sizes.h"

namespace octafront {

struct SurfaceMesh;

/// The gradation that the spread of sizes asks for: the least that leaves no more than a part of the elements to places
/// where sizes only rise, by the prediction on a coarse grid. kDefaultGradation where all sizes are alike. `curved`:
/// elements are of second order, and may grow faster.
double gradation_by_spread(const SurfaceMesh& surface, const WantedSizes& wanted, const SizeOptions& options,
                           bool curved, const RunContext& context);

}  // namespace octafront
