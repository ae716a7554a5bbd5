#pragma once

#include <octafront/vec.h>

#include "base/geometry/triangle_intersection.h"

namespace octafront {

inline Box3 box_of(const TriangleCorners& t) {
  return {min(min(t[0], t[1]), t[2]), max(max(t[0], t[1]), t[2])};
}

/// True if the triangle meets the box, both closed. Never misses a pair that meets; may accept one that is apart by
/// rounding (a relative 1e-14 of the box and triangle). Separating axes after T. Akenine-Moeller 2001.
bool triangle_overlaps_box(const TriangleCorners& t, const Box3& box);

/// The same for the segment pq.
bool segment_overlaps_box(Vec3 p, Vec3 q, const Box3& box);

/// Squared distance from p to the box, 0 inside.
constexpr double squared_distance(Vec3 p, const Box3& box) {
  return squared_length(max(max(box.lo - p, p - box.hi), Vec3{}));
}

}  // namespace octafront
