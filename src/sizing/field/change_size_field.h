#pragma once

#include <octafront/options.h>
#include <octafront/run_context.h>
#include <octafront/size_field.h>

#include "sizing/field/octree_field.h"

#include <vector>

namespace octafront {

/// The size field capped to `factor` of its own value within 1.5 of these values around each point. From there sizes
/// grow at the field's own gradation.
SizeField capped_near(const SizeField& sizes, const std::vector<Vec3>& points, double factor,
                      const RunContext& context);

/// How a cap goes on around its place.
struct CapShape {
  double reach = 1.5;    ///< the size of the place holds unchanged within so many times this size
  double gradation = 0;  ///< where this is more than the field's own, the whole new field may rise as fast
};

/// The size field capped to the sizes at the places.
SizeField capped_at(const SizeField& sizes, const std::vector<PointSize>& places, const RunContext& context,
                    const CapShape& shape = {});

/// All sizes multiplied by `factor`; where they then rise faster than the gradation they are cut.
SizeField scaled(const SizeField& sizes, double factor, const RunContext& context);

/// Cuts sizes of a field that rise faster than its gradation.
void grade_again(OctreeField& field, const RunContext& context);

}  // namespace octafront
