#pragma once

#include "layers/columns.h"
#include "layers/layered_walls.h"
#include "layers/region_walls.h"

namespace octafront::layers {

/// Normals that differ by less, as cosine, are of one plane: what single precision makes of it.
inline constexpr double kSamePlane = 1 - 1e-8;

/// Where layers end on flat patches without, their vertices move over: those inside such a patch go along with its rim,
/// less the farther they are from it. `columns` are those wished for; `wall` is what `walls` is of.
void make_room_on_bare(const Walls& walls, const Columns& columns, RegionWall& wall);

}  // namespace octafront::layers
