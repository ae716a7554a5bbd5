#pragma once

#include <octafront/run_context.h>

#include "sizing/field/octree_corners.h"
#include "sizing/field/octree_field.h"

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

namespace octafront {

/// An upper bound on sizes: h within `reach` of a box, growing at the gradation from there. Input units.
struct SizeCap {
  Vec3 lo, hi;  ///< the box; equal for a point
  double h = 0, reach = 0;

  double at(Vec3 q, double gradation) const {
    const Vec3 nearest = max(lo, min(q, hi));
    return h + gradation * std::max(0.0, distance(nearest, q) - reach);
  }
};

/// The field with the caps laid on: leaves are divided where these ask for smaller sizes, and all is graded again, by
/// `gradation`. Sizes only fall. O(leaves + caps log leaves) where few caps overlap.
std::shared_ptr<OctreeField> capped_grid(const OctreeField& field, const std::vector<SizeCap>& caps, double gradation,
                                         const RunContext& context);

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
