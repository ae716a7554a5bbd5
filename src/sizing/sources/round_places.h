#pragma once

#include "base/mesh/known_surface.h"
#include "sizing/sources/curvature.h"
#include "sizing/sources/surface_samples.h"

#include <vector>

namespace octafront {

/// Sizes where a body is round and thinner than its elements would be, as needles, rods and wires are: so many to a
/// turn that it keeps its volume within 5 %, but none below `floor`. Empty where there is no such place. `face`: the
/// sizes that are wanted there, per triangle. Refers to the surface.
SizeAtPlace sizes_in_round_places(const KnownSurface& known, const SurfaceCurvature& curvature,
                                  const std::vector<double>& face, double floor);

/// Sizes where a wall curves, as those of tubes do, and is so thin that facets of the wanted size on both its sides
/// would cross. As above.
SizeAtPlace sizes_in_curved_walls(const KnownSurface& known, const SurfaceCurvature& curvature,
                                  const std::vector<double>& face, double floor);

}  // namespace octafront
