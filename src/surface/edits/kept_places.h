#pragma once

#include "base/geometry/triangle_tree.h"
#include "surface/edits/walk.h"

#include <vector>

namespace octafront::surface {

/// A ball in which the input's own triangles are to stay.
struct KeptPlace {
  Vec3 center;
  double radius;
  bool in_vain = true;  ///< sizes were made smaller here, which did not help
};

/// Marks all edges of the input's triangles that reach into a kept place as features, because the front leaves a
/// triangle between three features as it is. `tree` holds the triangles of the input that are no backs. Returns by
/// vertex whether one of the marked triangles has it: such vertices must stay too.
std::vector<std::uint8_t> mark_kept_places(InputSurface& input, const TriangleTree& tree,
                                           const std::vector<KeptPlace>& balls);

}  // namespace octafront::surface
