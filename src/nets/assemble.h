#pragma once

#include <octafront/complex.h>

#include "nets/net.h"

#include <span>
#include <string>
#include <vector>

namespace octafront::nets {

/// The net as a complex of those of the labels that have quads, in their order; `names` of all labels.
Complex assemble(const Net& net, const Lattice& lattice, std::vector<Vec3> world, std::span<const Vec3> straight,
                 const std::vector<std::string>& names);

}  // namespace octafront::nets
