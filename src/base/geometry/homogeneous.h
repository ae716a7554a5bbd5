#pragma once

// Points and planes whose coordinates are rationals, by homogeneous coordinates without rounding: for the rare cases in
// which new points must be compared exactly.

#include <octafront/vec.h>

#include "base/geometry/big_float.h"

#include <array>

namespace octafront::exact {

/// Of a point: (x, y, z, w) with w > 0 stands for (x, y, z) / w. Of a plane: (n, k) is n . x + k = 0.
using Homogeneous = std::array<BigFloat, 4>;

/// Relative error of a rounded coordinate, 2^-50, with room for the error of a subtraction.
inline constexpr double kRounded = 1.8e-15;

inline BigFloat det2(const BigFloat& a, const BigFloat& b, const BigFloat& c, const BigFloat& d) {
  return a * d - b * c;
}

Homogeneous homogeneous(Vec3 p);

/// The plane through three points, positive where orient3d(a, b, c, .) is. By duality also the point where three planes
/// meet, but for the sign of all coordinates.
Homogeneous plane_through(const Homogeneous& a, const Homogeneous& b, const Homogeneous& c);
/// The same, with fewer operations.
Homogeneous plane_through(Vec3 a, Vec3 b, Vec3 c);

/// The linear form of the plane at the point: its sign says on which side the point lies.
BigFloat value(const Homogeneous& plane, const Homogeneous& p);

/// Where the line pq meets the plane, but for the sign of all coordinates. Requires that it is not parallel to it.
Homogeneous line_meets_plane(const Homogeneous& p, const Homogeneous& q, const Homogeneous& plane);
/// The point q * dp - p * dq: where a linear form that is dp at p and dq at q is zero on the line pq.
Homogeneous zero_between(const Homogeneous& p, const BigFloat& dp, const Homogeneous& q, const BigFloat& dq);

/// The same point with w > 0.
Homogeneous with_positive_weight(Homogeneous p);
/// The nearest doubles, with a relative error below 2^-50 in each coordinate. Requires w > 0.
Vec3 rounded(const Homogeneous& p);

}  // namespace octafront::exact
