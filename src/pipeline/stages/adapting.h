#pragma once

#include <octafront/adapt.h>
#include <octafront/options.h>
#include <octafront/tet_mesh.h>

#include "adapt/schedule/adapt_mesh.h"
#include "base/core/stage.h"
#include "pipeline/stages/run.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace octafront {

// What adapting meshes and surfaces have in common.

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

WallDeviation deviation_of(const adapt::Adapted& made);

/// Changes those elements of a mesh that Options::adapt says, all without looking at the others more than is needed to
/// find them: fits, checks and summaries are of what may change. `result.mesh` is the whole mesh; its report is not
/// filled in.
void adapt_section(const TetMesh& given, const adapt::MetricField& metric, const adapt::AdaptRules& rules,
                   AdaptedMesh& result, Run& run);

// What stays as it is while a mesh is adapted: what the options name, and what the mesh itself has as required.

/// Sets that are added to a mesh for as long as it is adapted, for sets go along with what they hold.
struct KeptItems {
  std::vector<std::uint32_t> sets;  ///< all that are to stay, by number
  std::vector<Triangle> faces;      ///< of them
  std::size_t own_sets = 0;         ///< how many the mesh had before
};
/// Throws OptionError for names of nothing that could stay.
KeptItems add_kept_items(TetMesh& mesh, const Options& options, const Stage& stage);
/// Takes away what was added.
void drop_kept_items(TetMesh& mesh, const KeptItems& kept);

// How far the walls of a mesh may stray where nothing is said: small bodies in large domains by their own size.

// Walls go where their ground is, each by itself: where a gap is narrower than that moves them they could meet. There
// they stay as they were.

/// The triangles of a boundary that cross others, two for each crossing.
std::vector<TriangleCorners> crossing_triangles(const std::vector<Vec3>& points, const std::vector<Triangle>& boundary,
                                                const Stage& stage);

/// Adapts by a metric and rules; returns the triangles that cross others then.
using TryWalls = std::function<std::vector<TriangleCorners>(const adapt::MetricField&, const adapt::AdaptRules&)>;
/// Tries until the boundary does not cross itself: where it would, walls of `given` stay, and what is around grows into
/// their sizes; where that is not enough all stay. Notes say so. The last try is the one that counts.
void keep_walls_apart(const TetMesh& given, const adapt::MetricField& metric, adapt::AdaptRules rules,
                      const TryWalls& attempt, const Stage& stage);

/// adapt_mesh() such that the boundary does not cross itself, by keep_walls_apart().
adapt::Adapted adapted_with_walls_apart(const TetMesh& given, const adapt::MetricField& metric, adapt::AdaptRules rules,
                                        const Stage& stage);

}  // namespace octafront
