#pragma once

#include <octafront/run_context.h>

#include "base/core/groups.h"
#include "images/nets/cells.h"
#include "images/nets/net.h"

#include <vector>

namespace octafront::nets {

/// The volume of each label by the net's triangles, in straight space.
std::vector<double> volumes_of(const Net& net, std::span<const Vec3> x, std::size_t labels);

/// Moves the vertices, each within its cell, until the labels have these volumes: each label's surface by a pressure of
/// its own, the least motion to first order. A volume of 0 or less stands for any. `pinned`: vertices that stay where
/// they are; empty: none does.
void keep_volumes(Net& net, const Groups<>& quads_at, const VertexCells& cells, const Lattice& lattice,
                  const std::vector<double>& wanted, std::vector<Vec3>& x, const RunContext& context,
                  std::span<const std::uint8_t> pinned = {});

}  // namespace octafront::nets
