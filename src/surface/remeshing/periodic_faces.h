#pragma once

// What a periodic cell asks of a round: sizes that are the same on opposite faces, and faces that are the same.

#include "periodic/periodic_cell.h"
#include "surface/remeshing/outcome.h"

namespace octafront::surface {

/// The sizes, made smaller where they are smaller at a copy of the place: on opposite faces they are the same up to a
/// percent, and around edges and corners of the cell.
SizeField periodic_sizes(const SizeField& sizes, const SurfaceMesh& input, const PeriodicFaces& periods,
                         const RunContext& context);

/// Puts copies of the triangles on faces at low ends in the place of what is on those at high ends. Vertices on the
/// borders of faces have their copies already; others are added.
void copy_periodic_faces(const SurfaceMesh& input, const PeriodicFaces& periods, Outcome& made);

}  // namespace octafront::surface
