#pragma once

#include <octafront/ids.h>
#include <octafront/no_context.h>
#include <octafront/tet_mesh.h>
#include <octafront/vec.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace octafront {

struct SurfaceMesh;

/// What became of the edges of a mesh when it was made one of second order, and how good its elements are.
struct SecondOrderSummary {
  std::uint64_t edges = 0;     ///< all; 0: the mesh is linear
  std::uint64_t curved = 0;    ///< mid-side node on the smooth surface
  std::uint64_t eased = 0;     ///< on the way to it, or straight, because an element would not be valid otherwise
  std::uint64_t straight = 0;  ///< inside, or where the surface is flat
  std::uint64_t moved = 0;     ///< corners on the boundary that moved from the input's triangles to the smooth surface
  std::uint64_t held = 0;      ///< those that could not, or only on the way
  std::uint64_t eased_faces = 0;  ///< of orders 3 and 4: whose inner nodes went back, for the same reason
  double largest_bend = 0;        ///< distance of a mid-side node from the middle of its edge, in parts of the edge
  /// Over all elements: the least (of orders 3 and 4 where an element is bent much: of the parts that it is halved
  /// into) of the Bernstein coefficients of the Jacobian's determinant over the determinant of the element with
  /// straight edges. 1: straight; above 0: valid (T. Toulorge, C. Geuzaine, J.-F. Remacle, J. Lambrechts, "Robust
  /// untangling of curvilinear meshes", 2013).
  double least_scaled_jacobian = 1;
  TetIndex least_tet = kNone;

  friend bool operator==(const SecondOrderSummary&, const SecondOrderSummary&) = default;
};

/// Makes a valid linear mesh one of second order (tet10, tri6). Edges inside are straight. Those of the boundary and of
/// interfaces follow the smooth surface that `surface` stands for (polynomials fitted to its vertices, sharp edges by
/// `feature_angle`, degrees); corners of the boundary move from its triangles to it. Without a `surface` all edges are
/// straight. Where an element would not be valid, its edges go back towards straight, by halves, until every element
/// is: all twenty Bernstein coefficients of its Jacobian positive by exact sign.
///
/// Sets of nodes get the mid-side nodes between their members only where a face or curve edge carries them. Throws
/// InputError if the mesh has mid-side nodes already, MeshingError if an element is so flat that rounding alone turns
/// its straight edges; Cancelled.
SecondOrderSummary make_second_order(TetMesh& mesh, const SurfaceMesh* surface = nullptr, double feature_angle = 40,
                                     const RunContext& context = no_context());

/// The same of order 2, 3 or 4 (tet10, tet20, tet35). Nodes lie where the barycentric coordinates are multiples of
/// 1 / order, those of boundary and interfaces on the smooth surface; elements beside them follow by the polynomials
/// that continue edges and faces. Each element is proven valid (check_jacobians()). Orders 3 and 4 are not for meshes
/// with periods. Throws OptionError for these and another order.
SecondOrderSummary make_curved(TetMesh& mesh, int order, const SurfaceMesh* surface = nullptr,
                               double feature_angle = 40, const RunContext& context = no_context());

/// Volume of a mesh of any order, curved as it is. Unit: input unit cubed.
double curved_volume(const TetMesh& mesh);

/// Drops all nodes but the corners.
void make_linear(TetMesh& mesh);

/// An element whose Jacobian is not proven positive.
struct InvalidElement {
  TetIndex tet = kNone;
  Vec3 at;                     ///< its centre
  double scaled_jacobian = 0;  ///< its least coefficient; see SecondOrderSummary
};

/// What the elements of a mesh of order 2 to 4 are, by the coordinates as they stand.
struct JacobianSummary {
  std::uint64_t invalid = 0;
  std::uint64_t undecided = 0;        ///< of these; of orders 3 and 4, where neither was proven
  std::vector<InvalidElement> first;  ///< the first ten of them
  double least_scaled_jacobian = 1;
  double mean_scaled_jacobian = 1;  ///< of the least of each element; straight ones count as 1
  TetIndex least_tet = kNone;
};

/// Looks at each element of a mesh of order 2 to 4. At order 2 it is invalid if one of the twenty coefficients is not
/// positive by exact sign. (Positive coefficients are enough for a valid element, and nearly needed: subdivision would
/// acquit a few more.) At orders 3 and 4 the same of 84 and 220, and the element is halved where some are not positive.
/// Of a linear mesh all are valid. About .4 s per million elements and thread at order 2.
JacobianSummary check_jacobians(const TetMesh& mesh, const RunContext& context = no_context());

}  // namespace octafront
