#pragma once

// The passes on triangles alone: as those of adapt/passes, in plain order.

#include "adapt/passes/metric_passes.h"
#include "adapt/schedule/sheet.h"

namespace octafront::adapt {

/// What passes over a sheet go by.
struct SheetGuide {
  const Guide& guide;
  bool outer = false;  ///< all triangles are turned one way, so what is turned away is another side
};

PassCount split_long_edges(Sheet& sheet, const SheetGuide& guide);
PassCount collapse_short_edges(Sheet& sheet, const SheetGuide& guide);
PassCount swap_edges(Sheet& sheet, const SheetGuide& guide);
/// Moves vertices, and draws those that are off to the surface that was given.
PassCount smooth_vertices(Sheet& sheet, const SheetGuide& guide);

}  // namespace octafront::adapt
