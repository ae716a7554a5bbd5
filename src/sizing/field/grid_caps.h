#pragma once

#include <octafront/run_context.h>

#include "sizing/field/octree_field.h"

#include <algorithm>
#include <memory>
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

}  // namespace octafront
