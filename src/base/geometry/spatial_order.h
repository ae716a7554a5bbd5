#pragma once

#include <octafront/surface_mesh.h>

#include <vector>

namespace octafront {

/// The points along a Z-order curve: order[k] is the k-th point. Neighbours in space become neighbours in memory.
std::vector<VertexIndex> spatial_order(const std::vector<Vec3>& points);

struct Cube {
  Vec3 lo;
  double side;
};
/// The same along the curve of a cube that holds the points.
std::vector<VertexIndex> spatial_order(const std::vector<Vec3>& points, const Cube& cube);

}  // namespace octafront
