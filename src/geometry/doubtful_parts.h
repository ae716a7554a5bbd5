#pragma once

#include "geometry/measures.h"
#include "geometry/triangle_tree.h"

#include <algorithm>
#include <cmath>

namespace octafront {

/// Parts of a triangle smaller than this part of the limit need not be divided further.
inline constexpr double kFinePart = 0.25;

/// Calls visit(p) for the middles of those small parts of a triangle of which is_within(p, distance) does not prove
/// that they lie within `limit` of something; is_within says whether p lies nearer to it than the distance. Parts that
/// reach no farther than finest(p) from their middle p are small. Ends, and is false, once visit returns false.
/// Distances change no faster than places: nothing of the triangle is farther than the limit and finest(p) but where p
/// was visited.
template <class IsWithin, class Finest, class Visit>
bool for_each_doubtful_part(const TriangleCorners& t, double limit, const IsWithin& is_within, const Finest& finest,
                            Visit&& visit) {
  const Vec3 middle = centroid(t[0], t[1], t[2]);
  const double reach = std::sqrt(
      std::max({squared_distance(middle, t[0]), squared_distance(middle, t[1]), squared_distance(middle, t[2])}));
  if (reach < limit && is_within(middle, limit - reach)) return true;
  if (reach <= finest(middle) || !is_within(middle, limit)) return visit(middle);
  const auto opposite = [&](int i) { return squared_distance(t[(i + 1) % 3], t[(i + 2) % 3]); };
  int i = 0;
  for (int k = 1; k < 3; ++k)
    if (opposite(k) > opposite(i)) i = k;
  const Vec3 a = t[i], b = t[(i + 1) % 3], c = t[(i + 2) % 3], half = (b + c) * 0.5;
  return for_each_doubtful_part({a, b, half}, limit, is_within, finest, visit) &&
         for_each_doubtful_part({a, half, c}, limit, is_within, finest, visit);
}

}  // namespace octafront
