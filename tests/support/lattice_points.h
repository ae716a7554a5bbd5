#pragma once

// RapidCheck generators of points on a small lattice, where coincident, collinear and coplanar points are common. The
// using test links rapidcheck.

#include <octafront/vec.h>

#include <rapidcheck.h>

namespace octafront::testing {

/// An integer in [-range, range], of full spread in every run of a property.
inline int lattice_coordinate(int range) {
  return *rc::gen::resize(100, rc::gen::inRange(-range, range + 1));
}

/// A point whose coordinates are multiples of `unit` up to `range` times it.
inline Vec3 lattice_point(int range, double unit = 1) {
  const int x = lattice_coordinate(range), y = lattice_coordinate(range), z = lattice_coordinate(range);
  return {x * unit, y * unit, z * unit};
}

}  // namespace octafront::testing
