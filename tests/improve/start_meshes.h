#pragma once

// Valid meshes that want improvement, made without the mesher.

#include <octafront/tet_mesh.h>

#include <cstdint>

namespace octafront::testing {

/// The unit cube as n^3 little cubes of six tetrahedra each (Kuhn), boundary and one patch per side in place.
TetMesh kuhn_cube(int n);

/// The inner vertices moved by up to `amount` / n in each direction, as far as every tetrahedron stays positive. The
/// same seed gives the same mesh.
TetMesh perturbed(TetMesh mesh, double amount, std::uint32_t seed);

/// `ring` tetrahedra around one edge of length 2 at x = `offset`, their other corners on the unit circle, the first at
/// x = 1: slivers if the offset is near 1.
TetMesh edge_ring_mesh(int ring, double offset);

/// Lists the faces that belong to one tetrahedron as the boundary, patch 0.
TetMesh with_boundary(TetMesh mesh);

/// Each point p becomes scale * p + shift.
TetMesh transformed(TetMesh mesh, double scale, Vec3 shift);

double volume(const TetMesh& mesh);

}  // namespace octafront::testing
