#pragma once

#include "fill/front/front_state.h"
#include "fill/front/front_task.h"
#include "fill/front/partition.h"

#include <limits>
#include <vector>

namespace octafront {

inline constexpr int kAllLayers = std::numeric_limits<int>::max();

/// What the blocks of a phase have in common. They read it, and change nothing of it.
struct FrontPhase {
  const FrontState& front;
  const FrontTask& task;
  AdvanceBudget budget;  ///< of each block
  int layers = 1;        ///< that a block works off
};

/// What a run of one block made. Vertices are numbered by the block: first those that it found, then its own.
struct BlockResult {
  std::vector<VertexIndex>
      found;                 ///< the front's numbers of the vertices that it found; none: faces have these already
  std::vector<Vec3> points;  ///< its own
  std::vector<float> sizes;
  std::vector<Tet> tets;
  std::vector<WaitingFace> queue;
  std::vector<FrontFace> held, passive;
  std::size_t deferred = 0;  ///< turns that reached beyond the block
  FrontWork work;
  FrontCounters counters;
};

/// Works off the owned faces of the queue that do not reach beyond the block, in order, and for more than one layer
/// also the layers that they leave. Takes the faces that it owns out of the front; gives back what remains of them, and
/// new ones.
BlockResult advance_block(const FrontPhase& phase, const FrontBlock& block);

}  // namespace octafront
