#pragma once

#include <octafront/size_field.h>

#include "surface/front/shaping.h"
#include "surface/lines/curve_points.h"

namespace octafront::surface {

/// Mends what the front left too long, too short or too flat: splits long edges inside patches, collapses short ones,
/// and turns edges, moves, adds or removes vertices of bad triangles where that makes the worst triangle around better.
void adjust_lengths(WorkingMesh& mesh, const InputSurface& input, CurvePoints& curve_points, const SizeField& sizes,
                    ImproveCounts& counts);
/// The last of these steps alone: the badly shaped triangles.
void mend_triangles(WorkingMesh& mesh, const InputSurface& input, CurvePoints& curve_points, const SizeField& sizes,
                    ImproveCounts& counts);

}  // namespace octafront::surface
