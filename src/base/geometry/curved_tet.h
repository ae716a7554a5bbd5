#pragma once

// The Jacobian of a tetrahedron of order 2, 3 or 4. Its determinant is a polynomial of degree 3 (p - 1); in the
// Bernstein basis it has 20, 84 or 220 coefficients. Where all are positive it is positive in the whole element; where
// one is not, halves of the element tell (A. Johnen, J.-F. Remacle, C. Geuzaine, "Geometrical validity of curvilinear
// finite elements", 2013).

#include <octafront/vec.h>

#include <array>
#include <span>
#include <vector>

namespace octafront {

/// What the Jacobian of an element is, rounded.
struct JacobianRange {
  double straight = 0;         ///< six times the volume of its corners
  double least = 0, most = 0;  ///< coefficients; all values lie between
  double volume = 0;           ///< of the element as it is curved
};

enum class Validity {
  kValid,      ///< its Jacobian is proven positive everywhere
  kInvalid,    ///< it is proven not to be, at some place
  kUndecided,  ///< too near to 0 to tell by this many halves
};

/// The place of an element where barycentric coordinates are `at` over the order; a node's own place, bit for bit,
/// where these are its weights.
Vec3 place_in_tet(int order, std::span<const Vec3> nodes, const std::array<double, 4>& at);

/// `nodes`: those of tet_lattice(order). About 2 microseconds at order 3, 9 at order 4.
JacobianRange jacobian_range(int order, std::span<const Vec3> nodes);

/// A bound from below for the Jacobian, sharper than its least coefficient: that of the parts that the element is
/// halved into, where it is worst, up to so many; rounded. About 2 microseconds a part.
double least_jacobian(int order, std::span<const Vec3> nodes, std::size_t parts);

/// All coefficients, rounded, by the nodes of tet_lattice(3 (order - 1)).
std::vector<double> jacobian_coefficients(int order, std::span<const Vec3> nodes);

/// A bound from below for the least coefficient over that of the element with straight edges, by how far nodes lie from
/// where they would be then. Sure in spite of rounding; 1 but for that where all are straight.
double least_scaled_jacobian_bound(int order, std::span<const Vec3> nodes);

/// Proven in spite of rounding: the bound is asked first, then coefficients with what they may be off, exact ones where
/// these are not sure, halves of the element where some are negative. Range of coordinates as in predicates.h.
Validity validity_of(int order, std::span<const Vec3> nodes);

}  // namespace octafront
