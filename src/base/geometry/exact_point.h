#pragma once

#include <octafront/vec.h>

#include "base/geometry/homogeneous.h"

namespace octafront::arrangement {

using exact::BigFloat;

using exact::Homogeneous;
using exact::plane_through;

/// A point whose place is rational: where planes through input vertices meet.
struct ExactPoint {
  Homogeneous place;
  Vec3 at;  ///< rounded, with a relative error below 2^-50 in each coordinate
};

/// A point, exact or of doubles.
struct Place {
  Vec3 at;
  const Homogeneous* exact = nullptr;  ///< null: `at` is the place
};

Homogeneous homogeneous(const Place& p);

/// The plane through the line ab that is parallel to an axis. Requires that the line is not.
Homogeneous plane_along_axis(Vec3 a, Vec3 b, int axis);

/// Where the line pq meets the plane. Requires that it is not parallel to it.
ExactPoint line_meets_plane(Vec3 p, Vec3 q, const Homogeneous& plane);
/// Where three planes meet. Requires that they do in one point.
ExactPoint planes_meet(const Homogeneous& a, const Homogeneous& b, const Homogeneous& c);

/// Lexicographic order of places by x, y, z, exactly: negative, zero or positive.
int compare(const Place& a, const Place& b);

/// Sign of the area of three points seen along the axis, exactly: orient2d of the coordinates behind it.
int orient_along(int axis, const Place& a, const Place& b, const Place& c);

}  // namespace octafront::arrangement
