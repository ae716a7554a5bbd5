#pragma once

#include "base/geometry/measures.h"
#include "base/geometry/needle.h"
#include "base/geometry/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace octafront {

/// What is known of a part of a triangle.
enum class Part { kWithin, kDivide, kVisit };

/// The corners of a part: a triangle, or a slice of a needle.
using PartCorners = std::span<const Vec3>;

/// How far the farthest corner is from p.
inline double reach_from(Vec3 p, PartCorners corners) {
  double most = 0;
  for (const Vec3 c : corners) most = std::max(most, squared_distance(p, c));
  return std::sqrt(most);
}

inline Box3 box_of_part(PartCorners corners) {
  Box3 box;
  for (const Vec3 p : corners) box.add(p);
  return box;
}

template <class Look, class Visit>
bool for_each_doubtful_part(const TriangleCorners& t, const Look& look, Visit&& visit);

/// for_each_doubtful_part() of the slice of a needle from t0 to t1: halves of it, and triangles where it is no longer
/// than about as high.
template <class Look, class Visit>
bool for_each_doubtful_slice(const Needle& needle, double t0, double t1, const Look& look, Visit&& visit) {
  const Needle::Corners corners = needle.corners(t0, t1);
  const double half = 0.5 * (t0 + t1);
  const Vec3 middle = needle.middle(half);
  const Part part = look(corners.span(), middle, reach_from(middle, corners.span()));
  if (part == Part::kWithin) return true;
  if (part == Part::kVisit) return visit(middle);
  if ((t1 - t0) * needle.length() > 2 * needle.height())
    return for_each_doubtful_slice(needle, t0, half, look, visit) &&
           for_each_doubtful_slice(needle, half, t1, look, visit);
  const auto& [a, b, c, d, apex] = corners.all;
  return for_each_doubtful_part({a, b, d}, look, visit) && for_each_doubtful_part({a, d, c}, look, visit) &&
         (corners.count == 4 || for_each_doubtful_part({c, d, apex}, look, visit));
}

/// Calls visit(p) for the middles p of those parts of a triangle of which look(part, p, reach) says that they are to be
/// visited; parts to be divided are. No corner of the part is farther from p than `reach`. Ends, and is false, once
/// visit returns false.
template <class Look, class Visit>
bool for_each_doubtful_part(const TriangleCorners& t, const Look& look, Visit&& visit) {
  const Vec3 middle = centroid(t[0], t[1], t[2]);
  const Part part = look(PartCorners(t), middle, reach_from(middle, t));
  if (part == Part::kWithin) return true;
  if (part == Part::kVisit) return visit(middle);
  if (const Needle needle(t); needle.is_one())
    return for_each_doubtful_slice(needle, 0, 0.5, look, visit) && for_each_doubtful_slice(needle, 0.5, 1, look, visit);
  const auto opposite = [&](int i) { return squared_distance(t[(i + 1) % 3], t[(i + 2) % 3]); };
  int i = 0;
  for (int k = 1; k < 3; ++k)
    if (opposite(k) > opposite(i)) i = k;
  const Vec3 a = t[i], b = t[(i + 1) % 3], c = t[(i + 2) % 3], half = (b + c) * 0.5;
  return for_each_doubtful_part({a, b, half}, look, visit) && for_each_doubtful_part({a, half, c}, look, visit);
}

/// Looks for what may lie farther than `limit` from something; is_within(p, distance) says whether p lies nearer to it
/// than the distance. Parts are divided until their middle p is no longer within `far`, or they reach no farther than
/// finest(p) from it, which must be a fair part of the triangle however small the limit is. Distances change no faster
/// than places: nothing of the triangle is farther than the limit and finest(p), but in parts that are visited.
template <class IsWithin, class Finest>
auto farther_than(double limit, double far, const IsWithin& is_within, const Finest& finest) {
  return [&, limit, far](PartCorners, Vec3 middle, double reach) {
    if (reach < limit && is_within(middle, limit - reach)) return Part::kWithin;
    return reach <= finest(middle) || !is_within(middle, far) ? Part::kVisit : Part::kDivide;
  };
}

}  // namespace octafront
