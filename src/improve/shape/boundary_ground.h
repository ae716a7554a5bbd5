#pragma once

// What is known of the input and takes time to find out, once for all workers.

#include "base/geometry/leeway.h"
#include "improve/shape/boundary_input.h"
#include "improve/shape/feature_curves.h"
#include "improve/shape/flat_walls.h"
#include "improve/shape/input_force.h"

namespace octafront::improve {

/// Const and thread-safe.
struct BoundaryGround {
  /// The input must outlive this.
  explicit BoundaryGround(const BoundaryInput& input)
      : leeway(input.surface, input.tree, input.bound),
        curves(input.surface, input.features),
        force(input),
        walls(input.surface, input.tree, input.features) {}

  Leeway leeway;
  FeatureCurves curves;
  InputForce force;
  FlatWalls walls;
};

}  // namespace octafront::improve
