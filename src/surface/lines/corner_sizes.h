#pragma once

#include "surface/lines/least_sizes.h"
#include "surface/lines/seams.h"

#include <cstdint>
#include <vector>

namespace octafront::surface {

/// The sizes, made smaller where the curves of a complex ask for that. Around a corner the size is at most the distance
/// to the next corner, and to the nearest curve that does not end at this corner; on a closed curve it is at most a
/// sixth of the curve's length. Where walls leave tiny edges, as in a foam, no vertex may move, and elements of the
/// wanted size would be flat. Away from such places sizes rise steeply. None falls below `least`. `is_fixed` as of
/// chained_curves().
SizeField fitted_to_corners(const InputSurface& input, const SeamedSurface& seamed, std::vector<std::uint8_t> is_fixed,
                            const SizeField& sizes, const LeastSizes& least, const RunContext& context);

}  // namespace octafront::surface
