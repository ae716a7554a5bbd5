#pragma once

#include <octafront/surface_mesh.h>

#include "soup/cells/misfit.h"

#include <algorithm>
#include <cmath>

namespace octafront::cells {

/// The sine of 20 degrees: wider wedges are none.
inline constexpr double kWideWedge = 0.34;

/// What elements suffer from, of walls that came together: short edges, flat triangles and narrow wedges.
struct WallShape {
  double shortest = HUGE_VAL;     ///< edge
  double thinnest = HUGE_VAL;     ///< height of a triangle
  double narrowest = kWideWedge;  ///< sine of a wedge, up to that
  Edge at{};                      ///< the edge of that wedge; of none, the shortest
  /// Triangles within walls are made anew, where edges between these stay: their heights count less.
  double worth() const {
    constexpr double kWithinWalls = 4;
    return std::min(shortest, kWithinWalls * thinnest) * narrowest;
  }
  bool has_no_wedge() const { return narrowest >= kWideWedge; }
};

WallShape shape_of_walls(const SurfaceMesh& complex);

/// Whether two bodies, whose walls may be meant to be one, face each other across nothing there, no farther apart than
/// their misfit. Regions have the numbers of the bodies.
bool leave_gaps(const SurfaceMesh& complex, const Misfits& misfits);

}  // namespace octafront::cells
