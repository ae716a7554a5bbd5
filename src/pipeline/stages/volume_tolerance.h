#pragma once

// What chords of elements cut off the regions: made less where the user asks for that, and refused where the mesh has
// lost more than they do.

#include <octafront/generate.h>

#include "pipeline/stages/stages.h"

#include <functional>
#include <vector>

namespace octafront {

/// The volumes that regions have in the input, and how deep chords may lie to keep them within a percent.
struct KnownVolumes {
  std::vector<double> volumes, depths;
};
/// By CAD where that is known, else by the surface.
KnownVolumes known_volumes(const Domain& domain);

/// Of CAD: throws MeshingError where regions of a linear mesh are off by more than what its chords cut off explains.
void refuse_lost_volumes(const Domain& domain, const Filled& filled, Run& run);

/// make(domain), again with smaller elements where regions are off by more than `percent`. Throws MeshingError where
/// that does not help.
Result with_volumes_within(double percent, const Domain& domain, const std::function<Result(const Domain&)>& make);

}  // namespace octafront
