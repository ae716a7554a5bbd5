#include "base/geometry/measures.h"

namespace octafront {

Vec3 closest_point_on_segment(Vec3 p, Vec3 a, Vec3 b) {
  const Vec3 u = b - a;
  const double along = dot(p - a, u), whole = squared_length(u);
  if (!(along > 0)) return a;
  if (along >= whole) return b;
  return a + u * (along / whole);
}

Vec3 closest_point_on_triangle(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
  // Below this squared sine of the angle at a the barycentric coordinates lose half their digits and more.
  constexpr double kNeedle = 1e-8;
  const Vec3 ab = b - a, ac = c - a, n = cross(ab, ac), ap = p - a;
  const double nn = squared_length(n);
  const double v = dot(cross(ap, ac), n), w = dot(cross(ab, ap), n);
  const bool needle = nn <= kNeedle * squared_length(ab) * squared_length(ac);
  Vec3 best = a;
  if (v >= 0 && w >= 0 && v + w <= nn && nn > 0) {
    best = a + ab * (v / nn) + ac * (w / nn);
    if (!needle) return best;
  }
  // Outside the prism over the triangle the nearest point lies on an edge whose side of the prism p is beyond.
  const auto try_edge = [&](Vec3 from, Vec3 to) {
    const Vec3 q = closest_point_on_segment(p, from, to);
    if (squared_distance(p, q) < squared_distance(p, best)) best = q;
  };
  if (v < 0 || needle) try_edge(a, c);
  if (w < 0 || needle) try_edge(a, b);
  if (v + w > nn || needle) try_edge(b, c);
  return best;
}

}  // namespace octafront
