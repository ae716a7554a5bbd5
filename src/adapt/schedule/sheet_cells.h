#pragma once

// A cycle of passes on triangles alone, in cells of space side by side.

#include "adapt/schedule/sheet_passes.h"

namespace octafront::adapt {

struct SheetCounts {
  PassCount split, collapse, swap, move;

  SheetCounts& operator+=(const SheetCounts& o) {
    split += o.split, collapse += o.collapse, swap += o.swap, move += o.move;
    return *this;
  }
  std::uint64_t changes() const { return split.done + collapse.done + swap.done + move.done; }
};

/// Each pass once, in the cells of this stage (base/shared). What lies across cells stays active for the next stage.
/// The same for any number of threads.
SheetCounts cycle_in_cells(Sheet& sheet, const SheetGuide& guide, int stage);

}  // namespace octafront::adapt
