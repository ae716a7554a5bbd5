#pragma once

// What adapting meshes and surfaces have in common.

#include <octafront/adapt.h>

#include "adapt/schedule/adapt_mesh.h"
#include "pipeline/stages/run.h"

#include <optional>

namespace octafront {

MetricSummary summary_of(const adapt::MetricFit& fit);

/// The surface that was given, as walls are drawn to it; none if there is none.
std::optional<adapt::GivenSurface> given_surface(const Domain* surface, double diagonal, Run& run);
/// `given` may be null.
adapt::AdaptRules rules_of(const Options& options, double diagonal, const adapt::GivenSurface* given);
/// The sizes that the options want, asked about a surface.
SizeField sizes_for(const SurfaceMesh& surface, Run& run);

/// Throws OptionError where sizes or a metric come to more elements than a mesh can hold.
void require_budget(double expected, const Stage& stage);

/// With options.improve.no_bridging avoid_bridges(); says what it did.
void divide_bridges(TetMesh& mesh, Run& run);

/// Throws InputError where the surface that was given is near no wall.
void require_near(const adapt::GivenFit& made);
/// Says where walls did not come to it.
void tell_given(const adapt::GivenFit& made, const Stage& stage);
void tell_fit(const MetricSummary& fit, const Stage& stage);
/// What could not be met, with the worst places.
void tell_unmet(const MetricSummary& fit, const WallDeviation& deviation, bool has_surface, const Stage& stage);

}  // namespace octafront
