#pragma once

#include <octafront/options.h>
#include <octafront/run_context.h>

#include "sizing/sources/wanted_sizes.h"

namespace octafront {

struct SurfaceMesh;

/// The gradation that the spread of sizes asks for: the least that leaves no more than a part of the elements to places
/// where sizes only rise, by the prediction on a coarse grid, and no more than `steepest`. kDefaultGradation where all
/// sizes are alike.
double gradation_by_spread(const SurfaceMesh& surface, const WantedSizes& wanted, const SizeOptions& options,
                           double steepest, const RunContext& context);

}  // namespace octafront
