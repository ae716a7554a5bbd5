#pragma once

// adapt/passes: the single passes that bring a piece nearer to a metric: edges that are too long are split, those too
// short collapsed, poor places connected anew, vertices moved. Each leaves every tet positive by exact sign, walls on
// the ground as near as they were or as is allowed, and what lies on the rim of the piece as it was.

#include <octafront/run_context.h>

#include "adapt/ground/ground.h"
#include "adapt/passes/piece.h"
#include "base/core/stage.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace octafront::adapt {

/// What the passes go by.
struct Guide {
  const MetricField& metric;
  const Ground& ground;
  double tolerance = 0;  ///< how far walls may stray from the smooth surface, at least; input units
  const RunContext& context;
  std::span<const std::uint8_t> kept = {};  ///< per part of walls: its triangles stay; empty: none do

  std::span<const double> tolerances = {};  ///< the tolerance per part of walls; empty: `tolerance`

  double tolerance_of(Wall wall) const { return tolerances.empty() ? tolerance : tolerances[(wall & ~kOuter) - 1]; }
  bool keeps(Wall wall) const { return !kept.empty() && wall != 0 && kept[(wall & ~kOuter) - 1] != 0; }
  /// Sets metric and density of a vertex from its place; one that is on the way keeps its own.
  void ask(Vertex& v) const {
    if (!v.exact) return;
    v.metric = metric.at(v.at, v.hint);
    v.density = density_of(v.metric);
  }
};

struct PassCount {
  std::uint64_t tried = 0, done = 0;
  bool unfinished = false;  ///< what is left to do waits for other pieces
  PassCount& operator+=(const PassCount& o) {
    tried += o.tried, done += o.done, unfinished |= o.unfinished;
    return *this;
  }
};

/// What all passes did.
struct Counts {
  PassCount split, collapse, swap, move, mend;
  bool grown = false;  ///< what is left to do waits for other pieces

  Counts& operator+=(const Counts& o) {
    split += o.split, collapse += o.collapse, swap += o.swap, move += o.move, mend += o.mend;
    grown |= o.grown;
    return *this;
  }
  std::uint64_t changes() const { return split.done + collapse.done + swap.done + move.done + mend.done; }
  void tell(const Stage& stage) const {
    stage.count("splits", static_cast<double>(split.done));
    stage.count("collapses", static_cast<double>(collapse.done));
    stage.count("swaps", static_cast<double>(swap.done));
    stage.count("moves", static_cast<double>(move.done));
  }
};

/// Splits edges longer than kLongest, the longest ones first by powers of sqrt 2, until none is left, the piece has so
/// many vertices, or what is left is much shorter than edges of the rim. New vertices of walls and lines go to the
/// ground, as far as the tets around allow. A split that makes edges shorter than `shortest` waits until the place is
/// connected better.
PassCount split_long_edges(Piece& piece, const Guide& guide, std::size_t most_vertices, double shortest);

/// Collapses edges shorter than kShortest, the shortest ones first, where that leaves no edge that is too long and no
/// element too poor, and walls true.
PassCount collapse_short_edges(Piece& piece, const Guide& guide);

/// Removes edges (of rings of up to seven tets) and faces of elements with a score below `threshold`, where the
/// elements of the place lack less together and none gets poor; edges inside walls turn, where the wall stays true.
PassCount swap_edges(Piece& piece, const Guide& guide, float threshold);

/// Moves each vertex of elements with a score below `threshold` towards where its elements lack the least together;
/// those on walls and lines along these.
PassCount smooth_vertices(Piece& piece, const Guide& guide, float threshold);

/// Makes poor elements (worth.h) better, one place at a time, as the worst element of the place goes: by other
/// connections than those that serve the sum, collapses, moves, and new vertices inside.
PassCount mend_poor(Piece& piece, const Guide& guide);
PassCount swap_poor(Piece& piece, const Guide& guide);
PassCount collapse_poor(Piece& piece, const Guide& guide);
PassCount move_poor(Piece& piece, const Guide& guide);
PassCount split_poor(Piece& piece, const Guide& guide);
PassCount insert_at_poor(Piece& piece, const Guide& guide);

/// Moves vertices of walls, lines and corners that are beside the surface that was given to it, as far as their
/// elements allow.
PassCount settle_on_ground(Piece& piece, const Guide& guide);

/// What a pass over walls has to ask: whether triangles may take the place of others of the same part. `near`: a
/// triangle of the ground that may be near, or kNone.
bool keeps_walls_true(const Guide& guide, std::span<const TriangleCorners> before,
                      std::span<const TriangleCorners> after, Wall wall, std::uint32_t near = kNone);
struct WallTriangle {
  TriangleCorners corners;
  Wall wall;
};
/// The same of several walls, none of which may vanish.
bool keep_walls_true(const Guide& guide, std::span<const WallTriangle> before, std::span<const WallTriangle> after,
                     std::uint32_t near = kNone);

}  // namespace octafront::adapt
