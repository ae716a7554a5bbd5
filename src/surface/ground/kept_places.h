#pragma once

#include "base/geometry/triangle_tree.h"
#include "surface/ground/walk.h"

#include <vector>

namespace octafront::remeshing {

/// A place where the input's own triangles are to stay.
struct Ball {
  Vec3 center;
  double radius;
  bool in_vain = true;  ///< sizes were made smaller here, which did not help
};

/// Marks all edges of the triangles that reach into the balls as features: what lies between lines on every side stays
/// as it is. `tree` holds the triangles of the input that are no backs. Returns which vertices those triangles have:
/// they must stay too.
std::vector<std::uint8_t> mark_restored(InputSurface& input, const TriangleTree& tree, const std::vector<Ball>& balls);

}  // namespace octafront::remeshing
