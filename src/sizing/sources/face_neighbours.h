#pragma once

#include <octafront/surface_mesh.h>

#include "base/mesh/edge_table.h"

#include <array>
#include <cstdint>
#include <vector>

namespace octafront {

/// Per triangle and corner i: the triangle across the edge from corner i to corner (i + 1) % 3; kNone where there is
/// not exactly one other.
using FaceNeighbours = std::vector<std::array<std::uint32_t, 3>>;

/// Edges of `features` count as boundaries: nothing lies across them.
FaceNeighbours smooth_face_neighbours(const EdgeTable& table, const std::vector<Edge>& features);

}  // namespace octafront
