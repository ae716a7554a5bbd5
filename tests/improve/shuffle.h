#pragma once

// The same mesh, kept otherwise: what improvement makes of it must not hang on where it keeps its elements.

#include "base/core/random.h"
#include "improve/schedule/mesh_of_pieces.h"

namespace octafront::improve {

/// Changes what a MeshOfPieces may choose freely: in which slots the tets lie, with free ones among them.
class SlotShuffle {
 public:
  explicit SlotShuffle(std::uint64_t seed) : random_(seed) {}
  void operator()(MeshOfPieces& mesh);

 private:
  Random random_;
};

}  // namespace octafront::improve
