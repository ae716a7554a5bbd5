#pragma once

#include <octafront/run_context.h>
#include <octafront/surface_mesh.h>

namespace octafront {

/// What triangles may become.
struct DecimationLimits {
  double edge = 0;          ///< none gets an edge longer than this
  double deviation = 0;     ///< root mean square of the distances from a vertex to all triangles that it stands for
  double sharp_angle = 40;  ///< degrees from which an edge is a line that stays
};

/// The complex with fewer triangles, by collapses of edges: a complex still, without crossings if it had none, with the
/// same regions and lines, its topology kept. What is flat stays flat. Vertices that many lines end at, or where
/// surfaces touch, do not move. REQUIRES triangles with area. The same for any number of threads.
///
/// Edges collapse in the order of passes with wider and wider bounds, to the place that is least by the quadrics of
/// their ends.
SurfaceMesh decimated(const SurfaceMesh& complex, const DecimationLimits& limits, const RunContext& context);

}  // namespace octafront
