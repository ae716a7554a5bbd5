#pragma once

#include <octafront/run_context.h>

#include "volume/attempt.h"
#include "volume/front_state.h"
#include "volume/partition.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace octafront {

/// Where a run stops, whatever remains: counted in work, not in time, so that the result never depends on the machine.
struct AdvanceBudget {
  std::size_t tets = 0;                                     ///< in all
  double volume = std::numeric_limits<double>::infinity();  ///< of what the front fills: more means that it leaks
  std::uint64_t face_tests = std::numeric_limits<std::uint64_t>::max();
};

/// What a run of one block made. Vertices are numbered by the block: first those that it found, then its own.
struct BlockResult {
  std::vector<VertexIndex> found;  ///< the front's numbers of the vertices that it found
  std::vector<Vec3> points;        ///< its own
  std::vector<float> sizes;
  std::vector<Tet> tets;
  std::vector<WaitingFace> queue;
  std::vector<Triangle> held, passive;
  double volume = 0;
  FrontCounters counters;
};

/// Scratch that a thread keeps from block to block.
struct BlockScratch {
  std::vector<std::uint32_t> local_number;  ///< per vertex of the front: a hint, true if `found` agrees
};

/// Works off the owned faces of the queue that do not reach beyond the block, in order, and for `layers` > 1 also the
/// layers that they leave. Takes the faces that it owns out of the front; gives back what remains of them, and new
/// ones.
BlockResult advance_block(const FrontState& front, const FrontBlock& block, int layers, const SizeField& sizes,
                          const VolumeOptions& options, const AdvanceBudget& budget, const RunContext& context,
                          BlockScratch& scratch);

}  // namespace octafront
