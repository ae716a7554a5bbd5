#pragma once

#include "base/dual/dual_points.h"

namespace octafront::dual {

/// From the middle of a wall face to the smooth surface that its corners and their normals tell of: what the dual's
/// boundary, whose points are middles of faces, would lose of a curved body. Nothing where the surface is flat.
Vec3 lift(const Primal& primal, const DualPoints& points, HalfFace wall);

}  // namespace octafront::dual
