#pragma once

#include "base/geometry/measures.h"
#include "base/geometry/triangle_tree.h"

#include <algorithm>
#include <cmath>

namespace octafront {

/// What is known of a part of a triangle.
enum class Part { kWithin, kDivide, kVisit };

/// Calls visit(p) for the middles p of those parts of a triangle of which look(part, p, reach) says that they are to be
/// visited; parts to be divided are. No corner of the part is farther from p than `reach`. Ends, and is false, once
/// visit returns false.
template <class Look, class Visit>
bool for_each_doubtful_part(const TriangleCorners& t, const Look& look, Visit&& visit) {
  const Vec3 middle = centroid(t[0], t[1], t[2]);
  const double reach = std::sqrt(
      std::max({squared_distance(middle, t[0]), squared_distance(middle, t[1]), squared_distance(middle, t[2])}));
  const Part part = look(t, middle, reach);
  if (part == Part::kWithin) return true;
  if (part == Part::kVisit) return visit(middle);
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
  return [&, limit, far](const TriangleCorners&, Vec3 middle, double reach) {
    if (reach < limit && is_within(middle, limit - reach)) return Part::kWithin;
    return reach <= finest(middle) || !is_within(middle, far) ? Part::kVisit : Part::kDivide;
  };
}

}  // namespace octafront
