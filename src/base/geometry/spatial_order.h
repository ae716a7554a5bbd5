#pragma once

#include <octafront/ids.h>
#include <octafront/vec.h>

#include <vector>

namespace octafront {

struct Cube {
  Vec3 lo;
  double side;
};
/// The place of a point on the Z-order curve of a cube that holds it: 63 bits, every third, from the highest on, of x.
std::uint64_t curve_code(Vec3 point, const Cube& cube);

/// The points along a Z-order curve: order[k] is the k-th point. Neighbours in space become neighbours in memory.
std::vector<VertexIndex> spatial_order(const std::vector<Vec3>& points);

}  // namespace octafront
