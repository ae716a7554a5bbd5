#pragma once

#include "soup/tidy/steps.h"

#include <cstdint>
#include <vector>

namespace octafront::mend {

struct Welded {
  std::uint64_t joined = 0, divided = 0;  ///< vertices; open edges
  double largest_move = 0;
  std::vector<Vec3> places;  ///< of vertices that were joined, or put into an edge
};

/// Brings open edges together: the ends of edges that fit become one vertex in their middle, and edges are divided at
/// vertices of open edges beside them. Nothing moves farther than the tolerance, no triangle loses a corner, and what
/// lies together in small triangles is not mistaken for a gap: edges fit if they differ by less than their length.
Welded weld_open_edges(tidy::Draft& draft, double tolerance);

}  // namespace octafront::mend
