#pragma once

#include "surface/remeshing/walk.h"

#include <vector>

namespace octafront::remeshing {

/// A place where the input's own triangles are to stay.
struct Ball {
  Vec3 center;
  double radius;
};

/// Marks all edges of the triangles that reach into the balls as features: what lies between lines on every side stays
/// as it is. Returns which vertices those triangles have: they must stay too.
std::vector<std::uint8_t> mark_restored(InputSurface& input, const std::vector<Ball>& balls);

}  // namespace octafront::remeshing
