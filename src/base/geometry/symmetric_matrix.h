#pragma once

#include <octafront/vec.h>

namespace octafront {

/// A symmetric 3 x 3 matrix that sums up: of least squares in space.
struct SymmetricMatrix {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

  /// Adds weight n n^T.
  void add(Vec3 n, double weight) {
    xx += weight * n.x * n.x, xy += weight * n.x * n.y, xz += weight * n.x * n.z;
    yy += weight * n.y * n.y, yz += weight * n.y * n.z, zz += weight * n.z * n.z;
  }
  /// Adds `weight` along all axes.
  void add_even(double weight) { xx += weight, yy += weight, zz += weight; }
  SymmetricMatrix& operator+=(const SymmetricMatrix& o) {
    xx += o.xx, xy += o.xy, xz += o.xz, yy += o.yy, yz += o.yz, zz += o.zz;
    return *this;
  }

  double trace() const { return xx + yy + zz; }
  Vec3 times(Vec3 p) const {
    return {xx * p.x + xy * p.y + xz * p.z, xy * p.x + yy * p.y + yz * p.z, xz * p.x + yz * p.y + zz * p.z};
  }
  /// The x with (this + damping) x = r, the damping along all axes; 0 where the sum is not positive definite.
  Vec3 damped_solve(Vec3 r, double damping) const {
    const double a = xx + damping, d = yy + damping, f = zz + damping;
    const double m0 = d * f - yz * yz, m1 = xz * yz - xy * f, m2 = xy * yz - xz * d;
    const double determinant = a * m0 + xy * m1 + xz * m2;
    if (!(determinant > 0)) return {};
    const double m3 = a * f - xz * xz, m4 = xy * xz - a * yz, m5 = a * d - xy * xy;
    return Vec3{m0 * r.x + m1 * r.y + m2 * r.z, m1 * r.x + m3 * r.y + m4 * r.z, m2 * r.x + m4 * r.y + m5 * r.z} /
           determinant;
  }
};

}  // namespace octafront
