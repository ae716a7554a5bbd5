#pragma once

#include <octafront/run_context.h>

#include "sizing/field/octree_corners.h"
#include "sizing/field/octree_field.h"

#include <memory>
#include <span>

namespace octafront {

/// Per corner the value, and what part of it a source of size asked for; the rest is what it grew by on the way.
struct GradedCorners {
  RawVector<double> value, source;
};

/// Corner values, as large as fairness allows, with value <= cap at every free corner, and a trilinear interpolant that
/// obeys |h(x) - h(y)| <= gradation |x - y| in the whole root cube, not only between corners; and the part of each
/// value that its source asked for, which is the whole of a ceiling.
///
/// `caps` has one entry per corner, in units of the root cube's side (as the values are); entries of hanging corners
/// are not read: what limits them must be laid on their shares. Values end at `ceiling`. At least one cap must be
/// finite or the ceiling be. Cost: about 3 microseconds per corner whose value is not its cap.
GradedCorners graded_corners(const Octree& tree, const OctreeCorners& corners, GradedCorners caps, double gradation,
                             double ceiling, const RunContext& context);
/// The field of such values.
std::shared_ptr<OctreeField> graded_field(const RootCube& root, Octree tree, const OctreeCorners& corners,
                                          std::span<const double> caps, double gradation, double ceiling,
                                          const RunContext& context);

}  // namespace octafront
