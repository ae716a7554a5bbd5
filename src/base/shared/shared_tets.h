#pragma once

// A mesh whose tetrahedra the ranks hold in shares. Points, faces and names are the same on all of them;
// `tets` and `region` are what a rank has. Every call is made by all ranks.

#include <octafront/tet_mesh.h>

#include "base/core/disjoint_sets.h"
#include "base/shared/comm.h"

#include <cstddef>
#include <cstdint>

namespace octafront {

/// What of a mesh's tetrahedra, and their regions, each rank has.
enum class Tets : std::uint8_t {
  kAll,    ///< all, in the same order
  kShare,  ///< some that no other has
};

/// How many all ranks together have, and the first ones before those of this rank.
struct TetCounts {
  std::uint64_t all = 0, before = 0;
};
TetCounts count_tets(const TetMesh& mesh, const Comm& comm);

/// Of tetrahedra that all ranks have, each keeps a stretch.
void keep_share(TetMesh& mesh, const Comm& comm);

/// All ranks get the tetrahedra of all, those of rank 0 first.
void gather_tets(TetMesh& mesh, const Comm& comm);

/// The first rank gets the tetrahedra of all, its own first; the others have none then.
void gather_tets_at_first(TetMesh& mesh, const Comm& comm);

/// Points that no tetrahedron of any rank uses go; the first `kept` stay where they are, used or not.
void drop_unused_points(TetMesh& mesh, std::size_t kept, const Comm& comm);

/// What is in one set on some rank then is on all.
void join_sets(DisjointSets& sets, std::size_t count, const Comm& comm);

}  // namespace octafront
