#pragma once

// volume: the volume front. Takes a clean surface and sizes; leaves tetrahedra of the wanted size whose boundary is
// that surface, triangle for triangle.
//
//   partition (blocks of space) -> front, front_index (open faces and what is near) -> advance, block_run (candidates,
//     attempt, meeting) -> ladder (backtrack, the means of the cavity room, recover_cavity) -> regions

#include "volume/fill.h"
#include "volume/ladder.h"
