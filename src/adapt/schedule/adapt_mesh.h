#pragma once

// adapt/schedule: a mesh brought to a metric. Takes a valid linear mesh and who knows the metric, leaves a valid mesh
// of the same body with the same patches, regions, curves, sheets and sets. Rounds: cells of space, a piece each, with
// the passes of adapt/passes; then other cells, until nothing is left to do.

#include <octafront/tet_mesh.h>

#include "adapt/ground/given.h"
#include "adapt/metric/metric.h"
#include "adapt/passes/piece.h"
#include "adapt/schedule/nearness.h"
#include "base/core/stage.h"
#include "base/mesh/labels.h"

#include <cstdint>
#include <span>
#include <vector>

namespace octafront::adapt {

/// How far the faces of a set of the mesh, by its number, may stray.
struct ToleranceOfSet {
  std::uint32_t set = 0;
  double tolerance = 0;  ///< > 0; input units
  bool strict = false;   ///< as of AdaptRules
};

struct AdaptRules {
  double feature_angle = 40;  ///< degrees
  double tolerance = 0;       ///< how far walls may stray from the smooth surface of the input; input units
  /// Whether elements become smaller than wanted where the surface deviated farther already when it came.
  bool strict = false;
  bool walls_ahead = true;  ///< as of take_step()
  /// Where walls lie instead of on their own smooth surface, as far as it is near them; null: nowhere.
  const GivenSurface* given = nullptr;
  std::span<const ToleranceOfSet> tolerances = {};  ///< of faces in several the least counts, in none that of all
  bool keep_walls = false;                          ///< vertices on walls, and all edges between them, stay as they are
  std::span<const std::uint8_t> kept = {};  ///< per vertex: it stays, and so does what lies between such; empty: none
  /// Per vertex whether it is frozen; edges, faces and elements between frozen vertices are, too, and elements with
  /// none but frozen vertices are not in the result. Empty: all may change. If the mesh was cut out of another, the
  /// vertices of the cut, faces of one element that are no boundary, must be frozen.
  std::span<const std::uint8_t> frozen = {};
  std::span<const std::uint32_t> kept_sets = {};  ///< sets of the mesh, by number, whose members stay: hold_sets()
};

/// How a mesh fits a metric, by the measures of the Unstructured Grid Adaptation Working Group.
struct MetricFit {
  std::uint64_t edges = 0, fitting = 0;  ///< edges, and those from kShortest to kLongest
  double shortest = 0, longest = 0;
  std::uint64_t far = 0;         ///< edges beyond half and twice of what is wanted
  Vec3 shortest_at, longest_at;  ///< middles of these edges
  double quality_min = 0, quality_mean = 0;
  Vec3 quality_min_at;    ///< the middle of the worst element
  double complexity = 0;  ///< the integral of sqrt(det M) over the mesh
};
MetricFit fit_of(const TetMesh& mesh, const MetricField& metric);

/// A MetricFit while it is found out.
class FitFinder {
 public:
  FitFinder(std::span<const Vec3> points, const MetricField& metric, std::size_t edges);
  const Vertex& at(VertexIndex v) const { return at_[v]; }
  /// Of an element around this middle.
  void add(double quality, double complexity, Vec3 middle);
  /// Each edge counts once.
  void add_edge(VertexIndex a, VertexIndex b);
  MetricFit found() const;

 private:
  std::vector<Vertex> at_;
  FlatSet<Edge> seen_;
  MetricFit fit_;
  double qualities_ = 0;
  std::size_t elements_ = 0;
};

/// What became of walls where a surface was given; nothing where none was.
struct GivenFit {
  std::uint64_t walls = 0, own_walls = 0;  ///< triangles of old walls; those that it is not near
  Vec3 own_wall_at;                        ///< the middle of the first of these
  /// Vertices that did not come to it, for elements would be poor or inside out, and the first one.
  std::uint64_t held = 0;
  Vec3 held_at;
};
GivenFit given_fit(const Ground& ground, std::span<const Vertex> vertices);

struct Adapted {
  TetMesh mesh;
  Origins from;  ///< of put_together(): per vertex the one of the input that it is
  /// Of the walls that could change from the smooth surface of the input: those of one tolerance together, the ones
  /// that come nearest to their bound, or beyond it most, first.
  std::vector<Deviation> deviations;

  GivenFit given;
};

/// Requires a valid linear mesh without wedges, pyramids, periods and split faces. The same bits for any number of
/// threads. Throws Cancelled, MeshingError.
Adapted adapt_mesh(const TetMesh& mesh, const MetricField& metric, const AdaptRules& rules, const Stage& stage);

}  // namespace octafront::adapt
