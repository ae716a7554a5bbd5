#pragma once

#include <octafront/surface_mesh.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace octafront {

/// Index of a tetrahedron in the `tets` of its mesh.
using TetIndex = std::uint32_t;

/// The anatomy of a tetrahedron, drawn once; everything else refers to it.
///
///            d                 Positive: seen from d, a, b, c turn counter-clockwise; that is
///           /|\                  orient3d(a, b, c, d) = ((b - a) x (c - a)) . (d - a) > 0.
///          / | \                 The unit tetrahedron (0,0,0) (1,0,0) (0,1,0) (0,0,1) is positive.
///         /  |  \              Face i is opposite corner i; its corners, as kTetFaces lists them, run
///        a---|---c               counter-clockwise seen from outside.
///         \  |  /              Half-face h = 4 * tet + i is face i of that tet.
///          \ | /               (This is the order of VTK, Gmsh and MEDIT.)
///            b
using Tet = std::array<VertexIndex, 4>;

/// Corners of face i (opposite corner i), counter-clockwise seen from outside.
inline constexpr std::array<std::array<int, 3>, 4> kTetFaces{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
/// Corners of the six edges.
inline constexpr std::array<std::array<int, 2>, 6> kTetEdges{{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

/// A tetrahedral mesh as flat arrays.
///
/// What leaves the library is *valid* (see first_defect): every tet is positive by exact sign, every face belongs to
/// one or two tets, the faces that belong to one are exactly `boundary`, and no vertex is unused.
struct TetMesh {
  std::vector<Vec3> points;              ///< input units
  std::vector<Tet> tets;                 ///< positive, indices into points
  std::vector<std::uint32_t> region;     ///< one per tet: number of the body it lies in; empty: all 0
  std::vector<Triangle> boundary;        ///< the boundary faces, counter-clockwise seen from outside
  std::vector<std::uint32_t> patch;      ///< one per boundary face: its patch; empty: all 0
  std::vector<std::uint32_t> source;     ///< one per boundary face: the input face nearest to it, or it; may be empty
  std::vector<std::string> patch_names;  ///< as in SurfaceMesh

  friend bool operator==(const TetMesh&, const TetMesh&) = default;
};

}  // namespace octafront
