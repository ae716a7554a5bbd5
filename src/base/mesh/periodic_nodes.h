#pragma once

#include <octafront/tet_mesh.h>

#include <cstdint>

namespace octafront {

/// Where a period of the mesh leads a place, in the order of operations that TetMesh::periodic_nodes names.
Vec3 led_by_period(const TetMesh& mesh, std::uint32_t period, Vec3 p);

/// Whether a node lies on the axis of a period that is a rotation: it is its own copy, and in no pair.
bool is_own_copy(const TetMesh& mesh, std::uint32_t period, VertexIndex v);

}  // namespace octafront
