#pragma once

#include <octafront/complex.h>

#include "images/nets/resolve_conflicts.h"

#include <span>
#include <vector>

namespace octafront::nets {

/// The net as a complex of those of the labels that have quads, in their order, with their names; with their values if
/// `keeps_values`. Notes say what settling did.
Complex assemble(const Net& net, const Lattice& lattice, ResolvedNet resolved, std::span<const Vec3> straight,
                 const std::vector<LabelImage::Label>& labels, bool keeps_values);

}  // namespace octafront::nets
