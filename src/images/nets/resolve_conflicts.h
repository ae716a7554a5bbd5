#pragma once

#include <octafront/run_context.h>

#include "base/core/groups.h"
#include "images/nets/net.h"

#include <vector>

namespace octafront::nets {

/// What it took.
struct Settled {
  std::vector<Vec3> world;       ///< per vertex
  std::uint64_t conflicts = 0;   ///< quads at fault at first
  std::uint64_t sharp = 0;       ///< quads that left sharp wedges at first
  std::uint64_t moved_back = 0;  ///< vertices
  std::uint64_t joined = 0;      ///< vertices that became one with others of their corner
};

/// Makes a complex of a net whose vertices were moved to x (straight space). The vertices of quads at fault go halfway
/// back to where they started, again and again; then all the way; then, but not for sharp wedges, the vertices of their
/// corner become one, at the corner. There the quads are faces of voxels, which do not cross: so this ends, always with
/// a complex.
Settled settle(Net& net, const Groups<>& quads_at, const Lattice& lattice, std::vector<Vec3>& x,
               const RunContext& context);

}  // namespace octafront::nets
