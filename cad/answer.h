#pragma once

#include "part.h"
#include "topology.h"

namespace octafront::cad {

/// Answers `triangulate`: frames up to kModel or kError. `opened` is the model without triangles. Works in a copy of
/// the process, so that what the library does not survive costs one attempt: the next one takes the face at which it
/// ended coarser.
void answer(const Part& part, const Topology& topology, const CadModel& opened, const Fineness& fineness,
            const Arguments& arguments);

}  // namespace octafront::cad
