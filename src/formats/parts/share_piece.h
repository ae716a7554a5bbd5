#pragma once

#include <octafront/tet_mesh.h>

#include "base/shared/comm.h"
#include "formats/parts/pieces.h"

namespace octafront::io {

/// The piece of a rank, of a mesh that several have in shares (base/shared): its own tetrahedra and one layer of those
/// of others, which the ranks tell each other. Points that only ghosts have may be said to be of another part than the
/// lowest one, never of this one. Called by all ranks. Of a mesh of first order without wedges, pyramids, interfaces
/// and sets.
Piece piece_of_share(const TetMesh& share, const Comm& comm);

/// What the whole mesh has.
WholeCounts counts_of_shares(const TetMesh& share, const Comm& comm);

}  // namespace octafront::io
