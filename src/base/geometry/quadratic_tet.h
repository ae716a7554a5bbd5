#pragma once

// The Jacobian of a tetrahedron of second order. Its determinant is a polynomial of degree three; in the Bernstein
// basis it has twenty coefficients, and where all are positive it is positive in the whole element (A. Johnen, J.-F.
// Remacle, C. Geuzaine, "Geometrical validity of curvilinear finite elements", 2013; P. L. George, H. Borouchaki,
// "Construction of tetrahedral meshes of degree two", 2012).

#include <octafront/vec.h>

#include <array>

namespace octafront {

/// Four corners, then the mid-side nodes in the order of kTetEdges (tet_mesh.h): 01 02 03 12 13 23.
using QuadraticTet = std::array<Vec3, 10>;

/// The twenty coefficients, rounded; those of a tetrahedron with straight edges are six times its volume, all of them.
/// In the order of indices i <= j <= k, the last one running fastest. About .2 microseconds.
std::array<double, 20> jacobian_coefficients(const QuadraticTet& nodes);

/// The determinant at a place, by its barycentric coordinates, rounded.
double jacobian_determinant(const QuadraticTet& nodes, const std::array<double, 4>& place);

/// A bound from below for the least coefficient over the determinant of the element with straight edges, without its
/// coefficients: 1 less what its bends can do at most. Sure in spite of rounding; 1 but for that where edges are
/// straight, below 0 where bends may be too much. About .03 microseconds.
double least_scaled_jacobian_bound(const QuadraticTet& nodes);

/// True if all twenty coefficients are positive, by exact sign: the element is valid, as its coordinates stand. Range
/// of coordinates as in predicates.h. The bound is asked first, then rounding: about
/// .03 and .3 microseconds; milliseconds where that is not sure.
bool has_positive_jacobian(const QuadraticTet& nodes);

}  // namespace octafront
