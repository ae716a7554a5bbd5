#pragma once

// Walls go where their ground is, each by itself: where a gap is narrower than that moves them they could meet. There
// they stay as they were.

#include "adapt/schedule/adapt_mesh.h"

namespace octafront {

/// adapt_mesh() such that the boundary does not cross itself. Where it would, walls stay, and what is around grows into
/// their sizes; where that is not enough all stay. Notes say so.
adapt::Adapted adapted_with_walls_apart(const TetMesh& given, const adapt::MetricField& metric, adapt::AdaptRules rules,
                                        const Stage& stage);

}  // namespace octafront
