#pragma once

// A cycle of passes on triangles alone, in cells of space side by side.

#include "adapt/schedule/sheet_passes.h"

namespace octafront::adapt {

/// Each pass once, in the cells of this stage (base/shared). What lies across cells stays active for the next stage.
/// The same for any number of threads.
Counts cycle_in_cells(Sheet& sheet, const SheetGuide& guide, int stage);

}  // namespace octafront::adapt
