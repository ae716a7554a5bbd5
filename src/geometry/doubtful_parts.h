#pragma once

#include "geometry/measures.h"
#include "geometry/triangle_tree.h"

#include <algorithm>
#include <cmath>

namespace octafront {

/// Calls visit(p) for the middles of those parts of a triangle of which is_within(p, distance) does not prove that they
/// lie within `limit` of something; is_within says whether p lies nearer to it than the distance. Parts are divided
/// until their middle p is no longer within `far`, or they reach no farther than finest(p) from it, which must be a
/// fair part of the triangle however small the limit is. Ends, and is false, once visit returns false. Distances change
/// no faster than places: nothing of the triangle is farther than the limit and finest(p), but in parts whose middles
/// were visited.
template <class IsWithin, class Finest, class Visit>
bool for_each_doubtful_part(const TriangleCorners& t, double limit, double far, const IsWithin& is_within,
                            const Finest& finest, Visit&& visit) {
  const Vec3 middle = centroid(t[0], t[1], t[2]);
  const double reach = std::sqrt(
      std::max({squared_distance(middle, t[0]), squared_distance(middle, t[1]), squared_distance(middle, t[2])}));
  if (reach < limit && is_within(middle, limit - reach)) return true;
  if (reach <= finest(middle) || !is_within(middle, far)) return visit(middle);
  const auto opposite = [&](int i) { return squared_distance(t[(i + 1) % 3], t[(i + 2) % 3]); };
  int i = 0;
  for (int k = 1; k < 3; ++k)
    if (opposite(k) > opposite(i)) i = k;
  const Vec3 a = t[i], b = t[(i + 1) % 3], c = t[(i + 2) % 3], half = (b + c) * 0.5;
  return for_each_doubtful_part({a, b, half}, limit, far, is_within, finest, visit) &&
         for_each_doubtful_part({a, half, c}, limit, far, is_within, finest, visit);
}

}  // namespace octafront
