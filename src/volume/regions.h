#pragma once

#include <octafront/surface_mesh.h>
#include <octafront/tet_mesh.h>

#include <cstdint>
#include <vector>

namespace octafront {

/// `mesh` fills `surface`, whose points come first: the surface's triangles and patches become its boundary, and its
/// tetrahedra get their regions.
void bind_to_surface(TetMesh& mesh, const SurfaceMesh& surface);

/// Bodies (outer shells with their cavities) numbered by their first triangle, per tetrahedron; empty if there is only
/// one. The first points of `mesh` are those of `surface`, which is its boundary.
std::vector<std::uint32_t> regions_of(const TetMesh& mesh, const SurfaceMesh& surface);

}  // namespace octafront
