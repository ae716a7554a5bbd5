#pragma once

// The nearest point of those triangles of a tree that fit.

#include "base/geometry/measures.h"
#include "base/geometry/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace octafront {

/// The nearest point within reach of p on a triangle for which fits(triangle, corners); the triangle is kNone if there
/// is none. `near`: a triangle that may be near, kNone: none is known; makes the search short, and changes no result.
template <class Fits>
TriangleTree::Nearest nearest_that(const TriangleTree& tree, Vec3 p, double reach, const Fits& fits,
                                   std::uint32_t near = kNone) {
  double limit = reach * reach;
  if (near != kNone) {
    const auto& [a, b, c] = tree.corners(near);
    limit = std::min(limit, std::nextafter(squared_distance(p, closest_point_on_triangle(p, a, b, c)), HUGE_VAL));
  }
  TriangleTree::Nearest first = tree.nearest(p, limit);
  // Boxes may be farther by rounding than what is in them.
  if (first.triangle == kNone && near != kNone) first = tree.nearest(p, reach * reach);
  if (first.triangle == kNone || fits(first.triangle, tree.corners(first.triangle))) return first;
  TriangleTree::Nearest best;
  best.squared_distance = reach * reach;
  const Vec3 r{reach, reach, reach};
  tree.for_each_box_near({p - r, p + r}, [&](std::uint32_t t, const TriangleCorners& c) {
    if (!fits(t, c)) return true;
    const Vec3 q = closest_point_on_triangle(p, c[0], c[1], c[2]);
    const double d = squared_distance(p, q);
    const bool nearer = d < best.squared_distance || (d == best.squared_distance && t < best.triangle);
    if (nearer) best = {q, t, d};
    return true;
  });
  return best;
}

}  // namespace octafront
