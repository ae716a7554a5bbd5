#include "base/geometry/leeway.h"

#include "base/geometry/measures.h"

#include <algorithm>

namespace octafront {

namespace {

/// Triangles this near to a place, in diagonals of the model, meet there: at a vertex or an edge, up to rounding.
constexpr double kTouching = 1e-12;
/// Rays start this part of the way to the centroid inside their triangle: along an edge they might pass by all others.
constexpr double kPartInside = 1e-6;
/// What lies across faces away from the place: the cosine between its normal and the way there is at least this.
constexpr double kFacing = 0.9;

}  // namespace

double Leeway::at(Vec3 p, double allowed) const {
  if (is_complex_) return allowed;
  const TriangleTree::Nearest home = tree_.nearest(p);
  if (home.triangle == kNone) return allowed;
  if (!bound_.empty()) allowed = std::min(allowed, bound_[home.triangle]);
  const double touching = kTouching * tree_.box().diagonal();
  const Vec3 around{touching, touching, touching};
  // Longer ways shorten nothing, and none is longer than the model.
  double most = std::min(allowed / kPart, tree_.box().diagonal());
  tree_.for_each_box_near({home.point - around, home.point + around}, [&](std::uint32_t, const TriangleCorners& t) {
    const Vec3 nearest = closest_point_on_triangle(home.point, t[0], t[1], t[2]);
    if (squared_distance(home.point, nearest) > touching * touching) return true;
    const Vec3 inside = home.point + (centroid(t[0], t[1], t[2]) - home.point) * kPartInside;
    most = way_through(home.point, inside, -unit_normal(t[0], t[1], t[2]), most);
    return true;
  });
  return std::min(allowed, kPart * most);
}

/// Up to the first triangle that faces away and does not touch the place at home; `most` if there is none nearer.
double Leeway::way_through(Vec3 home, Vec3 from, Vec3 inward, double most) const {
  const double touching = kTouching * tree_.box().diagonal();
  tree_.for_each_hit(from, from + inward * most, [&](std::uint32_t t, const SegmentHit& hit) {
    if (hit.kind != SegmentHit::Kind::kPoint) return;
    const auto& [a, b, c] = tree_.corners(t);
    const Vec3 normal = unit_normal(a, b, c);
    const double facing = dot(normal, inward);
    if (facing < kFacing) return;
    if (squared_distance(home, closest_point_on_triangle(home, a, b, c)) <= touching * touching) return;
    most = std::min(most, std::max(0.0, dot(a - from, normal) / facing));
  });
  return most;
}

}  // namespace octafront
