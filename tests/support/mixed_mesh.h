#pragma once

// A mesh of wedges, pyramids and tetrahedra, made without the mesher.

#include <octafront/tet_mesh.h>

namespace octafront::testing {

/// [0, n]^2 in two layers of wedges, 0 <= z <= 1/2, under n cubes of six tetrahedra for each; a pyramid on each of
/// their quadrilaterals at x = 0, with its apex at x = -1/2. Regions "layers" and "volume" with an interface, patches
/// by sides, one of them all pyramids', and a set of each kind.
TetMesh mixed_mesh(int n);

/// Moves all points by a polynomial of the second degree, which elements of second order follow exactly.
TetMesh bent_quadratically(TetMesh mesh);

}  // namespace octafront::testing
