#pragma once

#include "base/core/flat_map.h"
#include "base/mesh/known_surface.h"
#include "sizing/field/octree.h"
#include "sizing/sources/surface_samples.h"

#include <limits>
#include <memory>
#include <vector>

namespace octafront {

struct SurfaceMesh;

/// What is measured: walls and the gaps between them, or walls alone.
enum class Measured { kWallsAndGaps, kWalls };

/// Walls and gaps: how far it is from a place of the surface to the sheet that faces it, along the inward and the
/// outward normal. Places that lie close together on one side share an answer where triangles are small, so that dense
/// scans cost no more than coarse ones.
class GapFinder {
 public:
  static constexpr double kOpen = std::numeric_limits<double>::infinity();

  /// Looks as far as `reach`; nothing nearer than `nearest` is told apart from it.
  GapFinder(const KnownSurface& surface, double nearest, double reach, Measured what = Measured::kWallsAndGaps);

  /// Distance to the facing sheet; kOpen if there is none within reach. Sheets that meet at more than about 45 degrees
  /// do not face each other: an edge is no gap. The middle of the first triangle in a neighbourhood answers for it all;
  /// where there is none, the first place of the same triangle there that was asked for. So places of one triangle must
  /// be asked for by one thread, in one order; different triangles by any.
  double width(const PlaceOnSurface& place);
  /// The same of this place, shared by none.
  double measure(const PlaceOnSurface& place) const;

 private:
  std::uint64_t neighbourhood(const PlaceOnSurface& place) const;
  void measure_middles(const SurfaceMesh& surface);
  double distance_along(const PlaceOnSurface& place, Vec3 direction) const;

  const SurfaceMesh& surface_;
  const TriangleTree& tree_;
  Measured what_;
  std::vector<Vec3> normal_;
  RootCube root_;
  double nearest_, reach_;
  bool either_way_ = false;                       ///< of a complex, whose triangles do not face outward
  int level_;                                     ///< of the cells whose places share an answer
  using Widths = FlatMap<std::uint64_t, double>;  ///< by neighbourhood
  Widths known_;
  std::vector<std::unique_ptr<Widths>> inside_;  ///< of a triangle that reaches beyond its middle's; most have none
};

}  // namespace octafront
