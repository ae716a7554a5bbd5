#pragma once

#include <octafront/run_context.h>
#include <octafront/surface_mesh.h>

namespace octafront::mend {

/// A surface that a lattice found, and how much of it lies away from the walls.
struct LatticeSkin {
  SurfaceMesh surface;       ///< clean; `source`: the nearest wall of each triangle
  std::vector<char> is_far;  ///< per triangle: farther from the walls than an edge of the lattice
};

/// The boundary of what the walls wind around more than half, by isosurface stuffing with edges of this length at the
/// walls: always there, whatever the walls are, near them by about half an edge, closed and manifold. Throws
/// MeshingError if nothing is as large as an edge.
LatticeSkin skin_of_lattice(const SurfaceMesh& walls, double edge, const RunContext& context);

/// The outer boundary of all that lies within `distance` of the walls: a closed skin around anything.
LatticeSkin wrap_of(const SurfaceMesh& walls, double distance, const RunContext& context);

}  // namespace octafront::mend
