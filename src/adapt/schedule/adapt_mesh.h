#pragma once

// adapt/schedule: a mesh brought to a metric. Takes a valid linear mesh and who knows the metric, leaves a valid mesh
// of the same body with the same patches, regions, curves, sheets and sets. Rounds: cells of space, a piece each, with
// the passes of adapt/passes; then other cells, until nothing is left to do.

#include <octafront/tet_mesh.h>

#include "adapt/metric/metric.h"
#include "adapt/schedule/nearness.h"
#include "base/core/stage.h"

#include <cstdint>
#include <span>
#include <vector>

namespace octafront::adapt {

struct AdaptRules {
  double feature_angle = 40;  ///< degrees
  double tolerance = 0;       ///< how far walls may stray from the smooth surface of the input; input units
  /// Elements become smaller than wanted where walls that stray farther came so; else these are let be.
  bool strict = false;
  bool walls_ahead = true;  ///< as of take_step()
  bool keep_walls = false;  ///< vertices on walls, and all edges between them, stay as they are
  /// Per vertex: it stays, and so does what lies between vertices that do; elements with none but such vertices are not
  /// in the result. Empty: all may change. The faces of the mesh that are no walls of it are where it was cut out of
  /// another: their vertices must be frozen.
  std::span<const std::uint8_t> frozen = {};
};

/// How a mesh fits a metric, by the measures of the Unstructured Grid Adaptation Working Group.
struct MetricFit {
  std::uint64_t edges = 0, fitting = 0;  ///< edges, and those from kShortest to kLongest
  double shortest = 0, longest = 0;
  std::uint64_t far = 0;         ///< edges beyond half and twice of what is wanted
  Vec3 shortest_at, longest_at;  ///< middles of these edges
  double quality_min = 0, quality_mean = 0;
  double complexity = 0;  ///< the integral of sqrt(det M) over the mesh
};
MetricFit fit_of(const TetMesh& mesh, const MetricField& metric);

struct Adapted {
  TetMesh mesh;
  std::vector<VertexIndex> old_of_new;  ///< per vertex the one of the input that it is; kNone: new
  Deviation deviation;                  ///< of the walls that could change from the smooth surface of the input
  double bound = 0;                     ///< what was to be kept: the tolerance, or the deviation of walls as they came
};

/// Requires a valid linear mesh without wedges, pyramids, periods and split faces. The same bits for any number of
/// threads. Throws Cancelled, MeshingError.
Adapted adapt_mesh(const TetMesh& mesh, const MetricField& metric, const AdaptRules& rules, const Stage& stage);

}  // namespace octafront::adapt
