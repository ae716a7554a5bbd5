#pragma once

#include <octafront/run_context.h>

#include "volume/attempt.h"
#include "volume/front.h"

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

struct AdvanceResult {
  std::vector<FaceIndex> left;  ///< faces that found no tetrahedron at the last level: the walls of what remains open
  bool over_budget = false;     ///< stopped by the budget
};

/// Works off the queues: the current layer Qc in order, the faces it leaves make the next layer Qn, until both are
/// empty; faces without an acceptable tetrahedron wait in Qh and try again at the next level of `kLimits`. The
/// `passive` faces are only met by the others; what is left of them advances when the layers are done.
AdvanceResult advance_front(Front& front, std::vector<QueuedFace> layer, std::vector<QueuedFace> passive,
                            const SizeField& sizes, const VolumeOptions& options, const AdvanceBudget& budget,
                            const RunContext& context, FrontCounters& counters);

}  // namespace octafront
