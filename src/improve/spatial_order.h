#pragma once

#include <octafront/tet_mesh.h>

#include <vector>

namespace octafront::improve {

/// The vertices along a Z-order curve: order[k] is the k-th vertex. Neighbours in space become neighbours in memory.
std::vector<VertexIndex> spatial_order(const std::vector<Vec3>& points);

/// The tets in order of their least corner: order[k] is the k-th tet; equal ones keep their order.
std::vector<TetIndex> order_by_least_corner(const std::vector<Tet>& tets, std::size_t vertices);

}  // namespace octafront::improve
