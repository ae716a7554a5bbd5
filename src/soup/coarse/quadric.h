#pragma once

#include <octafront/vec.h>

#include <algorithm>
#include <cmath>

namespace octafront {

/// The weighted sum of squared distances to planes and lines, as a function of the place (M. Garland, P. Heckbert,
/// "Surface simplification using quadric error metrics", 1997).
struct Quadric {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;  ///< the matrix A
  Vec3 b;                                                 ///< the sum is p A p + 2 b p + c
  double c = 0;
  double weight = 0;

  /// Of the plane through p across the unit vector n.
  static Quadric of_plane(Vec3 n, Vec3 p, double weight) {
    const double d = -dot(n, p);
    return {weight * n.x * n.x, weight * n.x * n.y, weight * n.x * n.z,
            weight * n.y * n.y, weight * n.y * n.z, weight * n.z * n.z,
            n * (weight * d),   weight * d * d,     weight};
  }
  /// Of the line through p along the unit vector u.
  static Quadric of_line(Vec3 u, Vec3 p, double weight) {
    const Vec3 off = p - u * dot(u, p);
    return {weight * (1 - u.x * u.x),
            -weight * u.x * u.y,
            -weight * u.x * u.z,
            weight * (1 - u.y * u.y),
            -weight * u.y * u.z,
            weight * (1 - u.z * u.z),
            off * -weight,
            weight * dot(off, off),
            weight};
  }

  Quadric& operator+=(const Quadric& o) {
    xx += o.xx, xy += o.xy, xz += o.xz, yy += o.yy, yz += o.yz, zz += o.zz;
    b += o.b, c += o.c, weight += o.weight;
    return *this;
  }

  Vec3 times(Vec3 p) const {
    return {xx * p.x + xy * p.y + xz * p.z, xy * p.x + yy * p.y + yz * p.z, xz * p.x + yz * p.y + zz * p.z};
  }

  /// The mean of the squared distances; rounding may make it less than 0.
  double mean(Vec3 p) const { return weight > 0 ? (dot(p, times(p)) + 2 * dot(b, p) + c) / weight : 0; }

  /// Where on the way from p along `way` the sum is least: in [0, 1], parts of it.
  double least_along(Vec3 p, Vec3 way) const {
    const double bend = dot(way, times(way));
    return bend > 0 ? std::clamp(-dot(way, times(p) + b) / bend, 0.0, 1.0) : 0;
  }

  /// Where the sum is least; in directions in which it hardly changes, near `around`.
  Vec3 least(Vec3 around) const {
    constexpr double kPull = 1e-3;  // of the weight: planes of an even surface turn by more than this
    const double pull = kPull * weight;
    const double a = xx + pull, d = yy + pull, f = zz + pull;
    const Vec3 r = (times(around) + b) * -1.0;
    const double m0 = d * f - yz * yz, m1 = xz * yz - xy * f, m2 = xy * yz - xz * d;
    const double det = a * m0 + xy * m1 + xz * m2;
    if (!(det > 0)) return around;
    const double m3 = a * f - xz * xz, m4 = xy * xz - a * yz, m5 = a * d - xy * xy;
    return around +
           Vec3{m0 * r.x + m1 * r.y + m2 * r.z, m1 * r.x + m3 * r.y + m4 * r.z, m2 * r.x + m4 * r.y + m5 * r.z} / det;
  }
};

}  // namespace octafront
