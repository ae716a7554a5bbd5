#pragma once

#include <octafront/run_context.h>

#include "sizing/octree_corners.h"

#include <vector>

namespace octafront {

/// Per corner the value, and what part of it a source of size asked for; the rest is what it grew by on the way.
struct GradedCorners {
  std::vector<double> value, source;
};

/// Corner values, as large as fairness allows, with value <= cap at every free corner, and a trilinear interpolant that
/// obeys |h(x) - h(y)| <= gradation |x - y| in the whole root cube, not only between corners.
///
/// `caps` has one entry per corner, in units of the root cube's side (as the values are); entries of hanging corners
/// are not read: what limits them must be laid on their shares. Values end at `ceiling`. At least one cap must be
/// finite or the ceiling be. Cost: about 3 microseconds per corner whose value is not its cap.
std::vector<double> graded_corner_values(const Octree& tree, const OctreeCorners& corners,
                                         const std::vector<double>& caps, double gradation, double ceiling,
                                         const RunContext& context);
/// The same with the part of each cap that its source asked for, which is the whole of a ceiling.
GradedCorners graded_corners(const Octree& tree, const OctreeCorners& corners, const GradedCorners& caps,
                             double gradation, double ceiling, const RunContext& context);

}  // namespace octafront
