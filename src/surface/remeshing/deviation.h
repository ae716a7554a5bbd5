#pragma once

#include <octafront/surface_mesh.h>

#include "geometry/triangle_tree.h"

#include <vector>

namespace octafront::remeshing {

/// Points where two surfaces are farther apart than `limit`, looked for at the centroids, edge midpoints and vertices
/// of `made`, and at the vertices and edge midpoints of `input`. `input_tree` is over the triangles of `input`.
std::vector<Vec3> places_beyond(double limit, const SurfaceMesh& made, const SurfaceMesh& input,
                                const TriangleTree& input_tree);

}  // namespace octafront::remeshing
