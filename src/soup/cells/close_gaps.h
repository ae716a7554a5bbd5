#pragma once

#include <octafront/ids.h>
#include <octafront/run_context.h>
#include <octafront/vec.h>

#include <cstdint>
#include <vector>

namespace octafront::cells {

/// Triangles of several bodies in one soup.
struct BodySoup {
  const std::vector<Vec3>& points;
  const std::vector<Triangle>& triangles;
  const std::vector<std::uint32_t>& body;  ///< per triangle; no vertex belongs to two bodies
};

/// The same triangles, brought together.
struct ClosedGaps {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> source;  ///< per triangle: which one of the soup it is part of
  std::uint64_t moved = 0;            ///< vertices
  double largest_move = 0;
};

/// Brings bodies together that are nearer than the tolerance: vertices of later bodies move onto vertices, edges and
/// faces of earlier ones, and faces of each get the vertices and edges of the other that lie on them. What is left
/// between is cells of less than the tolerance. With a tolerance of 0 nothing changes.
ClosedGaps close_gaps(const BodySoup& soup, double tolerance, const RunContext& context);

}  // namespace octafront::cells
