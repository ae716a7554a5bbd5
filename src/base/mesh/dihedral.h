#pragma once

#include <octafront/vec.h>

#include "base/core/vector_units.h"

#include <array>
#include <cmath>

namespace octafront {

/// An angle in [0, 180] degrees as a direction of any length: its order needs neither a root nor an arc tangent.
struct AngleDirection {
  double x, y;  ///< y >= 0, not both 0

  bool is_below(const AngleDirection& other) const {
    const double turn = x * other.y - y * other.x;
    return turn > 0 || (turn == 0 && x > 0 && other.x < 0);
  }
};

/// The dihedral angles of a tetrahedron in the order of kTetEdges, by its edges from the first corner, of about length
/// one. From one determinant and the products of face normals: y over x keeps the digits of needles and slivers.
OCTAFRONT_KERNEL std::array<AngleDirection, 6> dihedral_directions(Vec3 u, Vec3 v, Vec3 w) {
  const Vec3 nb = cross(v, w), nc = cross(w, u), nd = cross(u, v), na = -(nb + nc + nd);
  const double det = std::abs(dot(u, nb));
  const auto angle = [det](Vec3 edge, Vec3 m, Vec3 n) {
    const double x = -dot(m, n), y = length(edge) * det;
    const bool is_nothing = std::abs(x) + y == 0;
    return AngleDirection{is_nothing ? 1 : x, y};
  };
  return {angle(u, nc, nd),     angle(v, nb, nd),     angle(w, nb, nc),
          angle(v - u, na, nd), angle(w - u, na, nc), angle(w - v, na, nb)};
}

}  // namespace octafront
