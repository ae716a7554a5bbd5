#pragma once

// surface/front: the advancing front on the surface. Takes divided curves and sizes; places points (front), and puts
// them into the input triangulation (insertion).

#include <octafront/run_context.h>
#include <octafront/size_field.h>

#include "surface/lines/curves.h"

#include <vector>

namespace octafront::surface {

/// A point that the front placed on the input surface.
struct FrontPoint {
  Vec3 p, normal;
  double h = 0;                  ///< wanted size there
  std::uint32_t face = kNone;    ///< of the input; it lies in it
  VertexIndex vertex = kNone;    ///< the input vertex that it is, if any
  HalfEdge half_edge = kNone;    ///< the feature half-edge that it lies on, if any
  std::uint32_t parent = kNone;  ///< the point it was placed from
  bool on_feature = false;
};

/// All points of the new surface: first those of the curves (each once; `curve_points[c]` lists them in order), then
/// those of the front.
struct FrontPoints {
  std::vector<FrontPoint> points;
  std::vector<std::vector<std::uint32_t>> curve_points;
  std::uint64_t candidates = 0;  ///< places that the front tried
};

/// The surface front. From every segment of a curve an apex on either side, then from every point, first in first out,
/// new points where the angle to its neighbours leaves room, near 60 degrees apart, at the wanted distance along the
/// surface. A place is taken if no point of the same sheet lies within 0.7 sizes. Components without curves start from
/// a seed. A wrong decision costs a point, never topology: the points are not connected here.
/// Where fronts meet the points lie closer or wider than wanted, which adds up to a few percent either way; then the
/// points are placed again by sizes that make up for it, so that as many are placed as the sizes ask for.
FrontPoints place_points(const InputSurface& input, const std::vector<Curve>& curves, const SizeField& sizes,
                         const RunContext& context);

}  // namespace octafront::surface
