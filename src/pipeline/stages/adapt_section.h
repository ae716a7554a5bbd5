#pragma once

#include <octafront/adapt.h>

#include "adapt/schedule/adapt_mesh.h"
#include "pipeline/stages/run.h"

namespace octafront {

WallDeviation deviation_of(const adapt::Adapted& made);

/// Changes those elements of a mesh that Options::adapt says, all without looking at the others more than is needed to
/// find them: fits, checks and summaries are of what may change. `result.mesh` is the whole mesh; its report is not
/// filled in.
void adapt_section(const TetMesh& given, const adapt::MetricField& metric, const adapt::AdaptRules& rules,
                   AdaptedMesh& result, Run& run);

}  // namespace octafront
