#pragma once

#include <octafront/ids.h>
#include <octafront/run_context.h>
#include <octafront/vec.h>

#include "base/geometry/triangle_side.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace octafront::cells {

/// How the sides of triangles hang together around edges: who walks on one side of a triangle over one of its edges,
/// without going through a wall, comes to which side of which triangle. Around an edge with one triangle that is its
/// other side.
struct SideGraph {
  std::vector<std::array<Side, 3>> next;  ///< per side; over edge i, from corner i to the next one
  std::vector<std::uint32_t> piece;       ///< per triangle: pieces of the surface that hang together over edges
  std::uint32_t pieces = 0;
};

/// Exact: triangles are sorted around each edge by signs alone. Requires triangles that meet in shared vertices and
/// edges only.
SideGraph make_side_graph(std::span<const Vec3> points, std::span<const Triangle> triangles,
                          const RunContext& context = {});

}  // namespace octafront::cells
