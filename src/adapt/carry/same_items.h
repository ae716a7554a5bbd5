#pragma once

#include <octafront/tet_mesh.h>

#include "adapt/carry/regions.h"

#include <cstdint>
#include <vector>

namespace octafront::adapt {

/// What two meshes have in common, as AdaptedMesh::old_of_new and old_tet_of_new say it.
struct SameItems {
  std::vector<VertexIndex> old_of_new;   ///< the first node at the same place, bit for bit
  std::vector<TetIndex> old_tet_of_new;  ///< the tet of the same region with the same nodes
  std::uint64_t several = 0;             ///< nodes at whose places the old mesh has more than one
};

SameItems same_items(const TetMesh& before, const TetMesh& now, const MatchedRegions& regions);

}  // namespace octafront::adapt
