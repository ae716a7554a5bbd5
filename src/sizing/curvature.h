#pragma once

#include <octafront/run_context.h>
#include <octafront/surface_mesh.h>

#include "sizing/face_neighbours.h"

#include <vector>

namespace octafront {

/// Curvature of the smooth parts of a surface, per triangle; unit 1 / input unit.
struct SurfaceCurvature {
  std::vector<double> largest;  ///< the larger magnitude of the two principal curvatures
  std::vector<double> sum;      ///< their sum, signed: positive where the surface is convex seen from outside
};

/// The curvature tensor of a polyhedron averaged over a ball of a few mean edges about each place, within the part of
/// the surface that can be reached without crossing a feature edge (D. Cohen-Steiner, J.-M. Morvan, "Restricted
/// Delaunay triangulations and normal cycle", 2003). Turning at feature edges does not count. Exact on prisms and
/// cylinders cut into strips; noise of the vertices cancels inside the ball. O(triangles).
SurfaceCurvature surface_curvature(const SurfaceMesh& surface, const FaceNeighbours& across, const RunContext& context);

}  // namespace octafront
