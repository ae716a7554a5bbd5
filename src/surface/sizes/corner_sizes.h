#pragma once

#include "surface/seams/seams.h"

#include <cstdint>
#include <vector>

namespace octafront::remeshing {

/// The sizes, no larger around each corner of a complex than it is from there to the nearest curve that does not end at
/// it, or to the next corner; on closed curves no larger than a sixth of them. Where walls leave tiny edges, as in a
/// foam, nothing may move, and elements of the wanted size would be flat. From there sizes rise steeply.
/// `is_fixed` as of chained_curves().
SizeField fitted_to_corners(const InputSurface& input, const SeamedSurface& seamed, std::vector<std::uint8_t> is_fixed,
                            const SizeField& sizes, const RunContext& context);

}  // namespace octafront::remeshing
