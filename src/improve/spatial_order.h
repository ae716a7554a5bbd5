#pragma once

#include <octafront/tet_mesh.h>

#include "core/groups.h"

#include <vector>

namespace octafront::improve {

/// The vertices along a Z-order curve: order[k] is the k-th vertex. Neighbours in space become neighbours in memory.
std::vector<VertexIndex> spatial_order(const std::vector<Vec3>& points);

/// The tets by their least corner.
Groups<> group_by_least_corner(const std::vector<Tet>& tets, std::size_t vertices);

}  // namespace octafront::improve
