#pragma once

#include <octafront/vec.h>

#include <cmath>

namespace octafront {

/// A right-handed frame at a point: `u` and `v` across `n`. At a point of a surface they are tangents and its normal.
struct Frame {
  Vec3 origin, u, v, n;
  Vec3 local(Vec3 p) const { return {dot(p - origin, u), dot(p - origin, v), dot(p - origin, n)}; }
};

/// With any two directions across the unit vector `n`.
inline Frame frame_at(Vec3 origin, Vec3 n) {
  const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
  const Vec3 least = x <= y && x <= z ? Vec3{1, 0, 0} : y <= z ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
  const Vec3 u = normalized(cross(n, least));
  return {origin, u, cross(n, u), n};
}

}  // namespace octafront
