#pragma once

#include <octafront/complex.h>

#include "soup/arrangement/arrange.h"
#include "soup/cells/find_cells.h"

#include <cstdint>
#include <vector>

namespace octafront::cells {

/// Which cells the walls of one file mean to be filled.
struct FilledCells {
  /// Per cell: how often it is inside; 0: empty, as cell 0 is. Below 0 in bodies that are inside out.
  std::vector<int> times;
  /// Enclosed cells that stay empty: the walls do not wind around them; or, where walls do not agree on their outer
  /// side, an even number of walls lies around them.
  std::uint64_t cavities_by_winding = 0, cavities_by_nesting = 0;
  std::uint64_t filled_shells = 0;  ///< pieces of the surface inside others that fill what they enclose
};

/// Piece by piece of the surface, from outside inwards. Where the triangles of a piece agree on their outer side around
/// every edge, also around those of four triangles and more, cells are inside as often as it winds around them; else,
/// where each edge has an even number of triangles, by nesting; else all cells of the piece are inside. `nested`:
/// kCavity goes by nesting wherever that is possible, kRegion leaves no cell empty.
FilledCells filled_cells(const Arrangement& arranged, const Cells& cells, ComplexOptions::Nested nested,
                         const RunContext& context);

}  // namespace octafront::cells
