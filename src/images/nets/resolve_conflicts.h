#pragma once

#include <octafront/run_context.h>

#include "base/core/groups.h"
#include "images/nets/mates.h"
#include "images/nets/net.h"

#include <vector>

namespace octafront::nets {

/// The vertices that make a complex of the net, and what that took.
struct ResolvedNet {
  std::vector<Vec3> world;       ///< per vertex
  std::uint64_t conflicts = 0;   ///< quads at fault at first
  std::uint64_t sharp = 0;       ///< quads that left sharp wedges at first
  std::uint64_t moved_back = 0;  ///< vertices
  std::uint64_t joined = 0;      ///< vertices that became one with others of their corner
};

/// Makes a complex of a net whose vertices were moved to x (straight space). The vertices of quads at fault go halfway
/// back to where they started, again and again, and then all the way. Where a quad is at fault even then, and not only
/// sharp, all vertices of a corner of the lattice become one vertex at that corner. Between such vertices quads are
/// faces of voxels, which do not cross, so the function always ends with a complex. `mates`: what is done to one vertex
/// is done to these, too.
ResolvedNet resolve_conflicts(Net& net, const Groups<>& quads_at, const Lattice& lattice, std::vector<Vec3>& x,
                              const RunContext& context, const Mates& mates = {});

}  // namespace octafront::nets
