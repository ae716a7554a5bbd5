#pragma once

#include <octafront/run_context.h>

#include "soup/arrangement/arrange.h"
#include "soup/cells/find_cells.h"

#include <cstdint>
#include <vector>

namespace octafront::mend {

/// Pieces of the soup that was arranged: neighbours in one piece agree on their outer side.
struct PieceOf {
  std::vector<std::uint32_t> piece;  ///< per triangle of the soup
  std::uint32_t count = 0;
  std::vector<char> is_sheet = {};  ///< per piece: it winds around nothing, whatever it looks like from nearby
};

struct Labels {
  std::vector<char> inside;            ///< per cell
  std::vector<char> turned;            ///< per piece: it faces the wrong way
  std::vector<double> winding;         ///< per cell, in the mean; not a number where a cell is too thin to look into
  std::uint64_t doubtful = 0;          ///< cells that the cut decided
  std::vector<std::uint32_t> filled;   ///< enclosed cells outside, thinner than the tolerance, that are inside now
  std::vector<std::uint32_t> emptied;  ///< cells inside of bodies thinner than the tolerance, that are outside now
};

/// Which cells are inside: those that the walls wind around more than half. A piece that shows its back to the
/// unbounded cell is turned before. Cells in doubt go where the least area of walls comes to lie between inside and
/// outside.
Labels label_cells(const Arrangement& arranged, const Cells& cells, const PieceOf& pieces, double tolerance,
                   const RunContext& context);

}  // namespace octafront::mend
