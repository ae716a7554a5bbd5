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

/// True if all twenty coefficients are positive, by exact sign: the element is valid, as its coordinates stand. Range
/// of coordinates as in predicates.h. Rounding is asked first; about .3 microseconds where it is sure, milliseconds
/// where it is not.
bool has_positive_jacobian(const QuadraticTet& nodes);

}  // namespace octafront
