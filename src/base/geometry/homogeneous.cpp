#include "base/geometry/homogeneous.h"

namespace octafront::exact {
namespace {

BigFloat exact_difference(double a, double b) {
  return BigFloat(a) - BigFloat(b);
}

}  // namespace

Homogeneous homogeneous(Vec3 p) {
  return {BigFloat(p.x), BigFloat(p.y), BigFloat(p.z), BigFloat(1.0)};
}

Homogeneous plane_through(const Homogeneous& a, const Homogeneous& b, const Homogeneous& c) {
  // Expanded along a: the 2x2 minors of b and c.
  const auto m = [&](int i, int j) { return det2(b[i], b[j], c[i], c[j]); };
  const BigFloat m01 = m(0, 1), m02 = m(0, 2), m03 = m(0, 3), m12 = m(1, 2), m13 = m(1, 3), m23 = m(2, 3);
  return {a[1] * m23 - a[2] * m13 + a[3] * m12, -(a[0] * m23 - a[2] * m03 + a[3] * m02),
          a[0] * m13 - a[1] * m03 + a[3] * m01, -(a[0] * m12 - a[1] * m02 + a[2] * m01)};
}

Homogeneous plane_through(Vec3 a, Vec3 b, Vec3 c) {
  std::array<BigFloat, 3> u, v;
  for (int i = 0; i < 3; ++i) {
    u[i] = exact_difference(b[i], a[i]);
    v[i] = exact_difference(c[i], a[i]);
  }
  Homogeneous plane{det2(u[1], u[2], v[1], v[2]), det2(u[2], u[0], v[2], v[0]), det2(u[0], u[1], v[0], v[1]), {}};
  plane[3] = -(plane[0] * BigFloat(a.x) + plane[1] * BigFloat(a.y) + plane[2] * BigFloat(a.z));
  return plane;
}

BigFloat value(const Homogeneous& plane, const Homogeneous& p) {
  return plane[0] * p[0] + plane[1] * p[1] + plane[2] * p[2] + plane[3] * p[3];
}

Homogeneous line_meets_plane(const Homogeneous& p, const Homogeneous& q, const Homogeneous& plane) {
  return zero_between(p, value(plane, p), q, value(plane, q));
}

Homogeneous zero_between(const Homogeneous& p, const BigFloat& dp, const Homogeneous& q, const BigFloat& dq) {
  Homogeneous h;
  for (int i = 0; i < 4; ++i) h[i] = dp * q[i] - dq * p[i];
  return h;
}

Homogeneous with_positive_weight(Homogeneous p) {
  if (p[3].sign() < 0)
    for (BigFloat& x : p) x = -x;
  return p;
}

Vec3 rounded(const Homogeneous& p) {
  return {quotient(p[0], p[3]), quotient(p[1], p[3]), quotient(p[2], p[3])};
}

}  // namespace octafront::exact
