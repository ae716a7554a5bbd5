#pragma once

// Meshes that have everything a TetMesh can hold, made without the mesher.

#include <octafront/tet_mesh.h>

namespace octafront::testing {

/// [0, n]^3 as n^3 cubes of six tetrahedra, n even: two regions that meet at x = n / 2, with the interface between
/// them, a patch per side, the twelve edges of the cube as curves, sets of each kind, and names, odd ones among them.
TetMesh rich_mesh(int n);

/// The same mesh of second order; mid-side nodes in the middle of their edges.
TetMesh with_mid_nodes(TetMesh mesh);

/// The same mesh of order 3 or 4; nodes at their places in straight elements.
TetMesh with_high_nodes(TetMesh mesh, int order);

}  // namespace octafront::testing
