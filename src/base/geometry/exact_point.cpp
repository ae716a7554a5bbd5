#include "base/geometry/exact_point.h"

#include "base/geometry/predicates.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace octafront::arrangement {
namespace {

using exact::det2;
using exact::kRounded;

ExactPoint exact_point(Homogeneous h) {
  h = exact::with_positive_weight(std::move(h));
  const Vec3 at = exact::rounded(h);
  return {std::move(h), at};
}

BigFloat difference(double a, double b) {
  return BigFloat(a) - BigFloat(b);
}

/// The two coordinates of a place that are seen along an axis, and w.
std::array<BigFloat, 3> seen_along(int axis, const Place& p) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  if (p.exact) return {(*p.exact)[u], (*p.exact)[v], (*p.exact)[3]};
  return {BigFloat(p.at[u]), BigFloat(p.at[v]), BigFloat(1.0)};
}

int orient_exact(int axis, const Place& a, const Place& b, const Place& c) {
  const auto x = seen_along(axis, a), y = seen_along(axis, b), z = seen_along(axis, c);
  const BigFloat det =
      x[0] * det2(y[1], y[2], z[1], z[2]) - x[1] * det2(y[0], y[2], z[0], z[2]) + x[2] * det2(y[0], y[1], z[0], z[1]);
  return det.sign();
}

}  // namespace

Homogeneous homogeneous(const Place& p) {
  return p.exact ? *p.exact : exact::homogeneous(p.at);
}

Homogeneous plane_along_axis(Vec3 a, Vec3 b, int axis) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  Homogeneous plane;
  plane[u] = -difference(b[v], a[v]);
  plane[v] = difference(b[u], a[u]);
  plane[3] = -(plane[u] * BigFloat(a[u]) + plane[v] * BigFloat(a[v]));
  return plane;
}

ExactPoint line_meets_plane(Vec3 p, Vec3 q, const Homogeneous& plane) {
  return exact_point(exact::line_meets_plane(exact::homogeneous(p), exact::homogeneous(q), plane));
}

ExactPoint planes_meet(const Homogeneous& a, const Homogeneous& b, const Homogeneous& c) {
  return exact_point(exact::plane_through(a, b, c));
}

int compare(const Place& a, const Place& b) {
  for (int i = 0; i < 3; ++i) {
    const double gap = a.at[i] - b.at[i];
    const double error = (a.exact || b.exact) ? kRounded * (std::abs(a.at[i]) + std::abs(b.at[i])) : 0;
    if (std::abs(gap) > error) return gap > 0 ? 1 : -1;
    if (!a.exact && !b.exact) continue;
    const Homogeneous p = homogeneous(a), q = homogeneous(b);
    if (const int sign = det2(p[i], p[3], q[i], q[3]).sign(); sign != 0) return sign;
  }
  return 0;
}

int orient_along(int axis, const Place& a, const Place& b, const Place& c) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  if (!a.exact && !b.exact && !c.exact) return orient2d(a.at[u], a.at[v], b.at[u], b.at[v], c.at[u], c.at[v]);
  const double bu = b.at[u] - a.at[u], bv = b.at[v] - a.at[v], cu = c.at[u] - a.at[u], cv = c.at[v] - a.at[v];
  const double det = bu * cv - bv * cu;
  const auto size = [&](const Place& p) { return std::max(std::abs(p.at[u]), std::abs(p.at[v])); };
  const double error = 2 * kRounded * std::max({size(a), size(b), size(c)});
  const double bound = error * (std::abs(bu) + std::abs(bv) + std::abs(cu) + std::abs(cv) + 2 * error) +
                       1e-15 * (std::abs(bu * cv) + std::abs(bv * cu));
  if (det > bound || det < -bound) return det > 0 ? 1 : -1;
  return orient_exact(axis, a, b, c);
}

}  // namespace octafront::arrangement
