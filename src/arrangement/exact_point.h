#pragma once

#include <octafront/vec.h>

#include "geometry/big_float.h"

#include <array>

namespace octafront::arrangement {

using exact::BigFloat;

/// Of a point: (x, y, z, w) with w > 0 stands for (x, y, z) / w. Of a plane: (n, k) is n . x + k = 0.
using Homogeneous = std::array<BigFloat, 4>;

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

/// The plane through three points, positive where orient3d(a, b, c, .) is.
Homogeneous plane_through(Vec3 a, Vec3 b, Vec3 c);
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
