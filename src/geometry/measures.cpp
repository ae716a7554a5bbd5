#include "geometry/measures.h"

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
  const Vec3 ab = b - a, ac = c - a, n = cross(ab, ac);
  const double nn = squared_length(n);
  Vec3 best = a;
  if (nn > 0) {
    const Vec3 ap = p - a;
    const double v = dot(cross(ap, ac), n), w = dot(cross(ab, ap), n);
    if (v >= 0 && w >= 0 && v + w <= nn) {
      best = a + ab * (v / nn) + ac * (w / nn);
      if (nn > kNeedle * squared_length(ab) * squared_length(ac)) return best;
    }
  }
  // Outside the prism over the triangle the nearest point lies on an edge.
  for (const Vec3 q :
       {closest_point_on_segment(p, a, b), closest_point_on_segment(p, b, c), closest_point_on_segment(p, c, a)})
    if (squared_distance(p, q) < squared_distance(p, best)) best = q;
  return best;
}

}  // namespace octafront
