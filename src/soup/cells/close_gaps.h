#pragma once

#include <octafront/ids.h>
#include <octafront/run_context.h>
#include <octafront/vec.h>

#include "soup/cells/misfit.h"

#include <cstdint>
#include <vector>

namespace octafront::cells {

/// The same triangles, brought together.
struct ClosedGaps {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> source;  ///< per triangle: which one of the soup it is part of; ascending
  std::uint64_t moved = 0;            ///< vertices
  double largest_move = 0;
};

/// Where the wall of a later body turns away from an earlier one: it goes through vertices and edges of that which are
/// near beside its own edges, or stays in its plane.
enum class Rims { kBend, kKeep };

/// Brings walls of bodies together that are nearer than their misfit: vertices of later bodies move onto vertices,
/// edges and faces of earlier ones, which stay where they are, and faces of each get the vertices and edges of the
/// other that lie on them. What is left between is cells thinner than the misfit. Without any nothing changes.
ClosedGaps close_gaps(const BodySoup& soup, const Misfits& misfits, Rims rims, const RunContext& context);

}  // namespace octafront::cells
