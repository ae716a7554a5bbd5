#pragma once

#include "base/geometry/frame.h"
#include "base/geometry/predicates.h"

#include <cstddef>
#include <utility>

namespace octafront::mend {

/// A point seen along a direction.
struct Flat {
  double x = 0, y = 0;
  friend bool operator==(const Flat&, const Flat&) = default;
};

inline Flat seen_along(const Frame& frame, Vec3 p) {
  return {dot(p, frame.u), dot(p, frame.v)};
}

inline int turn(Flat a, Flat b, Flat c) {
  return orient2d(a.x, a.y, b.x, b.y, c.x, c.y);
}

/// Whether the polygon of `corners` points at(0), at(1), ... has q inside, exactly.
template <class At>
bool is_inside(std::size_t corners, const At& at, Flat q) {
  bool inside = false;
  for (std::size_t i = 0; i < corners; ++i) {
    Flat a = at(i), b = at((i + 1) % corners);
    if ((a.y > q.y) == (b.y > q.y)) continue;
    if (a.y > b.y) std::swap(a, b);
    if (turn(a, b, q) > 0) inside = !inside;
  }
  return inside;
}

}  // namespace octafront::mend
