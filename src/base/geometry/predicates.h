#pragma once

// Exact signs. Every decision about topology in this library is one of these: a floating-point filter first (inline),
// then exact stages of rising cost; see predicates.cpp (J. R. Shewchuk, "Adaptive Precision Floating-Point Arithmetic
// and Fast Robust Geometric Predicates", 1997). Requires that the compiler neither contracts nor reassociates; see
// cmake/OctafrontTargets.cmake.
//
// Exact for finite coordinates that are 0 or of magnitude 1e-40 ... 1e50: then no product of five differences
// overflows, and none of its bits underflows. (Coordinates are multiples of 2^-53 * 1e-40, so the lowest bit of such a
// product is above 1e-280; the highest is below 1e255.)

#include <octafront/vec.h>

#include "base/core/vector_units.h"

namespace octafront {

namespace detail {
int orient3d_exact(Vec3 a, Vec3 b, Vec3 c, Vec3 d);
int orient2d_exact(double ax, double ay, double bx, double by, double cx, double cy);
int insphere_exact(Vec3 a, Vec3 b, Vec3 c, Vec3 d, Vec3 e);
constexpr int sign(double x) {
  return (x > 0) - (x < 0);
}
}  // namespace detail

namespace detail {
struct Orient3dEstimate {
  double det, permanent;
  // Shewchuk's bound A for this expression, (7 + 56 eps) eps with eps = 2^-53.
  int certain_sign() const {
    const double bound = 7.7715611723761027e-16 * permanent;
    return (det > bound) - (det < -bound);
  }
};

/// The determinant alone, with the bits that the estimate has.
OCTAFRONT_KERNEL double orient3d_det(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const Vec3 u = b - a, v = c - a, w = d - a;
  return u.x * (v.y * w.z - v.z * w.y) + u.y * (v.z * w.x - v.x * w.z) + u.z * (v.x * w.y - v.y * w.x);
}

inline Orient3dEstimate orient3d_estimate(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const Vec3 u = b - a, v = c - a, w = d - a;
  const double vw = v.y * w.z, wv = v.z * w.y, vx = v.z * w.x, xv = v.x * w.z, vy = v.x * w.y, yv = v.y * w.x;
  return {u.x * (vw - wv) + u.y * (vx - xv) + u.z * (vy - yv), std::abs(u.x) * (std::abs(vw) + std::abs(wv)) +
                                                                   std::abs(u.y) * (std::abs(vx) + std::abs(xv)) +
                                                                   std::abs(u.z) * (std::abs(vy) + std::abs(yv))};
}
}  // namespace detail

/// Sign of ((b - a) x (c - a)) . (d - a): +1 if (a, b, c, d) is a positive tetrahedron (see tet_mesh.h), 0 if coplanar.
inline int orient3d(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const auto estimate = detail::orient3d_estimate(a, b, c, d);
  const int certain = estimate.certain_sign();
  if (certain != 0) return certain;
  if (estimate.permanent == 0) return 0;  // all products vanish: common on axis-parallel planes
  return detail::orient3d_exact(a, b, c, d);
}

/// The sign of orient3d where floating point is sure of it, else 0: for tests that have a cheaper way out than the
/// exact sign of nearly coplanar points.
inline int orient3d_filter(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  return detail::orient3d_estimate(a, b, c, d).certain_sign();
}

/// Sign of the area of (a, b, c) in the plane: +1 counter-clockwise, 0 collinear.
inline int orient2d(double ax, double ay, double bx, double by, double cx, double cy) {
  const double l = (ax - cx) * (by - cy), r = (ay - cy) * (bx - cx), det = l - r;
  const double bound = 3.3306690738754716e-16 * (std::abs(l) + std::abs(r));
  if (det > bound || det < -bound) return detail::sign(det);
  return detail::orient2d_exact(ax, ay, bx, by, cx, cy);
}

/// +1 if e lies strictly inside the sphere through the positive tetrahedron (a, b, c, d), 0 on it, -1 outside.
/// For a negative tetrahedron the sign is reversed.
int insphere(Vec3 a, Vec3 b, Vec3 c, Vec3 d, Vec3 e);

/// True if the three points lie on one line, exactly.
bool collinear(Vec3 a, Vec3 b, Vec3 c);

}  // namespace octafront
