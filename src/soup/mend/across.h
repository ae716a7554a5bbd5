#pragma once

#include <octafront/vec.h>

#include <array>
#include <cmath>

namespace octafront::mend {

/// Two unit vectors across a unit vector and each other, such that all three are right-handed.
inline std::array<Vec3, 2> axes_across(Vec3 n) {
  const Vec3 size{std::abs(n.x), std::abs(n.y), std::abs(n.z)};
  Vec3 least{0, 0, 1};
  if (size.x < size.y && size.x < size.z) least = {1, 0, 0};
  if (size.y <= size.x && size.y < size.z) least = {0, 1, 0};
  const Vec3 u = normalized(cross(least, n));
  return {u, cross(n, u)};
}

}  // namespace octafront::mend
