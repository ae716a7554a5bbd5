#pragma once

#include <octafront/options.h>

#include "base/mesh/known_surface.h"
#include "sizing/field/background_grid.h"

#include <vector>

namespace octafront {

/// What options.named asks for.
struct NamedSizes {
  std::vector<double> face;        ///< per triangle, infinite where nothing is asked; empty: nowhere
  std::vector<SizeSample> points;  ///< along curves and inside regions
};

/// Sizes that are asked for in a box or ball by `named` become some of `regions`. Throws OptionError.
void take_places_in_space(SizeOptions& options);

/// Finds the regions, patches and curves that are named. Throws OptionError for names that there are not, and for sizes
/// that would make more elements than a mesh can hold.
NamedSizes named_sizes(const KnownSurface& surface, const SizeOptions& options);

}  // namespace octafront
