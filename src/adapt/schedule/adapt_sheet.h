#pragma once

// A surface alone brought to a metric: triangles without tetrahedra, open or closed, any number of them
// at an edge. Takes one whose triangles have three corners each, leaves one with the same patches, lines and corners.

#include <octafront/surface_mesh.h>

#include "adapt/metric/metric.h"
#include "adapt/schedule/adapt_mesh.h"
#include "base/core/stage.h"

#include <span>
#include <vector>

namespace octafront::adapt {

/// The measures of fit_of() for triangles: quality is area over the sum of squared edges, complexity the integral of
/// the density of the metric within the surface.
MetricFit fit_of(const SurfaceMesh& surface, const MetricField& metric);

struct AdaptedSheet {
  SurfaceMesh surface;
  std::vector<VertexIndex> old_of_new;  ///< per vertex the one of the input that it is; kNone: new
  Deviation deviation;
  GivenFit given;
};

/// Vertices listed in `fixed` stay. Requires indices in range, finite coordinates, three corners for each triangle.
/// `rules.frozen` has no say. The same for any number of threads. Throws Cancelled.
AdaptedSheet adapt_sheet(const SurfaceMesh& surface, const MetricField& metric, const AdaptRules& rules,
                         std::span<const VertexIndex> fixed, const Stage& stage);

}  // namespace octafront::adapt
