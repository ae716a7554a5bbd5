#pragma once

#include "fill/front/front_state.h"
#include "fill/front/front_task.h"

namespace octafront {

/// Works off the queues of a front, until all are empty or nothing more fits.
///
/// The work goes in phases. Each phase divides space into blocks (partition.h); a block takes the faces that reach into
/// it, advances those whose whole search region lies strictly inside it, and gives back what remains. Blocks therefore
/// touch nothing of each other's and run in parallel; their results are joined in the order of the blocks. Faces that
/// reach beyond their block wait for the next phase, which divides space at other places. Nothing depends on the number
/// of threads.
///
/// A phase is a layer (the paper's Qc; what it leaves is Qn). Faces without an acceptable tetrahedron are held (Qh) and
/// try again at the next level of `kLimits`. Passive faces are only met by the others; what is left of them advances
/// when the layers are done. What is `held` at the end are the walls of what remains open. False if it was stopped by
/// the budget. Adds to `counters`.
bool advance_front(FrontState& front, const FrontTask& task, const AdvanceBudget& budget, FrontCounters& counters);

}  // namespace octafront
