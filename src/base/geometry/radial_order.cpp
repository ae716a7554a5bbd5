#include "base/geometry/radial_order.h"

#include "base/geometry/predicates.h"

#include <algorithm>

namespace octafront {

RadialOrder::RadialOrder(Vec3 from, Vec3 to, Vec3 first) : a_(from), b_(to), first_(first) {
  // Any point off the plane tells the two halves of the plane apart.
  const double step = std::max({length(b_ - a_), length(first_ - a_), 1e-300});
  for (const Vec3 way : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
    off_plane_ = a_ + way * step;
    up_ = orient3d(a_, b_, first_, off_plane_);
    if (up_ != 0) break;
  }
}

bool RadialOrder::operator()(Vec3 p, Vec3 q) const {
  const int half_p = half(p), half_q = half(q);
  if (half_p != half_q) return half_p < half_q;
  return orient3d(a_, b_, p, q) > 0;
}

/// 0: at the first one, 1: within half a turn of it, 2: opposite, 3: beyond.
int RadialOrder::half(Vec3 p) const {
  const int side = orient3d(a_, b_, first_, p);
  if (side != 0) return side > 0 ? 1 : 3;
  return orient3d(a_, b_, p, off_plane_) == up_ ? 0 : 2;
}

}  // namespace octafront
