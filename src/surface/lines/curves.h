#pragma once

// surface/lines: lines that stay: features and patch borders chained into curves, cleared of noise (curve_noise),
// divided by size; points that slide along them (curve_points), lines that run closer together than elements
// (merge_lines).

#include <octafront/size_field.h>

#include "periodic/periodic_cell.h"
#include "surface/edits/walk.h"

#include <vector>

namespace octafront::surface {

/// A point of a feature curve: on an input half-edge at a + t (b - a), or exactly at an input vertex.
struct CurvePoint {
  Vec3 p;
  HalfEdge half_edge = kNone;  ///< runs along the curve
  double t = 0;
  double along = 0;            ///< length of the curve up to the point
  VertexIndex vertex = kNone;  ///< the input vertex that the point is; kNone inside the half-edge
  double h = 0;                ///< wanted size
};

/// A chain of feature edges between two corners, or closed, and its division.
struct Curve {
  std::vector<HalfEdge> half_edges;  ///< of the input, head to tail
  bool closed = false;               ///< no corner on it
  std::vector<double> reach;         ///< length of the curve up to the end of each half-edge
  std::vector<CurvePoint> samples;   ///< in order; the first and the last are the ends (closed: the same point)
  std::vector<CurvePoint> middles;   ///< one for each segment between samples
};

/// The feature lines to keep at the element's scale: `features` and all patch borders, without what is noise below the
/// size. Needs `input` without feature marks.
std::vector<Edge> features_at_scale(const InputSurface& input, const Features& features, const SizeField& sizes);

/// Chains the marked feature edges of `input` into curves that end at corners: vertices where other than two of them
/// meet, those of `corners` where the curve bends at the element's scale, and those marked in `is_fixed` (one per
/// vertex, or empty).
std::vector<Curve> chain_curves(const InputSurface& input, const std::vector<VertexIndex>& corners,
                                const std::vector<std::uint8_t>& is_fixed, const SizeField& sizes);

/// Per vertex whether chain_curves() ends curves there.
std::vector<std::uint8_t> corner_marks(const InputSurface& input, const std::vector<VertexIndex>& corners,
                                       const std::vector<std::uint8_t>& is_fixed, const SizeField& sizes);

/// Curves that are copies of each other, and vertices that are.
struct SharedCurves {
  std::vector<std::uint32_t> group = {};  ///< per curve: the first of its copies; empty: none has others
  std::vector<std::uint32_t> twin = {};   ///< the same by copies at other places, moved by periods; may be empty
  std::vector<VertexIndex> place = {};    ///< per vertex: the same for copies; empty: there are none
  const PeriodicCell* cell = nullptr;     ///< whose periods they are; needed with twins
};

/// Divides the curves: integral of ds / h rounded to a whole number of segments, spread evenly. Closed curves, and
/// loops at one corner, get at least three segments, two curves between the same corners never one each. Copies are
/// divided alike, and points of copies at other places are copies of each other, bit for bit.
void divide_curves(const InputSurface& input, const SizeField& sizes, std::vector<Curve>& curves,
                   const SharedCurves& shared = {});

/// The point that lies at this length along the curve.
CurvePoint point_along(const InputSurface& input, const Curve& curve, double along);

}  // namespace octafront::surface
