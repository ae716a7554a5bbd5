#pragma once

#include <octafront/vec.h>

#include "soup/mend/fair.h"

#include <span>

namespace octafront::mend {

/// A cap that keeps off the surface: walls from the rim to a flat base across `away`, a unit vector, which is as far
/// beyond the rim and everything that stands over the base as this part of the rim's diameter. Detail of the rim below
/// half of that does not reach the base. `around`: points of the surface. Without triangles where there is no such
/// cap: where the base's outline would cross itself, or what stands over it is too high.
FairCap cap_with_base(std::span<const Vec3> rim, Vec3 away, std::span<const Vec3> around);

/// How thick what the base closes is at least: this part of the rim's diameter.
inline constexpr double kBaseThickness = 0.02;

}  // namespace octafront::mend
