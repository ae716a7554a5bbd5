#pragma once

#include <octafront/run_context.h>

#include "base/mesh/edge_table.h"
#include "surface/remeshing/mend_folds.h"

#include <optional>

namespace octafront::surface {

/// A surface without its folds, and what that took.
struct Unfolded {
  SurfaceMesh surface;  ///< clean, of the same topology; patches and sources kept
  MendedFolds mended;   ///< `moved`: per triangle of `surface`
};

/// The input without folds, flaps and spikes that can be taken away within the tolerance in all (input units); see
/// mend_folds(). Patch borders stay. `edges` as make_edge_table() makes them. nullopt if nothing was done. Requires a
/// clean surface.
std::optional<Unfolded> unfold(const SurfaceMesh& surface, const EdgeTable& edges, double tolerance,
                               const RunContext& context);

}  // namespace octafront::surface
