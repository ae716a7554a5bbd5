#pragma once

#include "images/nets/net.h"

#include <span>

namespace octafront::nets {

/// Gives each quad the diagonal whose triangles keep the voxels on its two sides apart, and of two such ones that with
/// the larger smallest angle. `x`: the vertices in straight space.
void choose_diagonals(Net& net, const Lattice& lattice, std::span<const Vec3> x);
void choose_diagonal(Net& net, const Lattice& lattice, std::span<const Vec3> x, std::uint32_t quad);

}  // namespace octafront::nets
