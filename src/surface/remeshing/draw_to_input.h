#pragma once

#include "surface/edits/deviation.h"
#include "surface/edits/working_mesh.h"

#include <span>

namespace octafront::surface {

/// No new triangle is worse than this 2r/R, unless one was: what is mended for its shape deviates again.
inline constexpr double kFairShape = 0.35;

/// Brings the mesh nearer to the input where the mesh deviates. Each place names a triangle of the mesh (by its number
/// there) and a point of the input. A triangle that faces as the input does at the point gets the point as a vertex:
/// inside, on one of its edges, or as the new place of its nearest corner. Where none of these is sound, an edge of the
/// triangle is halved, and its middle put on the input. No change makes new crossings, which is tested exactly.
///
/// Of several places at one triangle only the farthest counts, so the caller must look again for what still deviates.
/// `tree` is over the input's triangles. `is_fixed` says by vertex which ones stay; vertices beyond its end may move.
/// No new triangle has a 2r/R below `least_shape`, unless an old one had. Returns the number of points put in.
std::uint64_t draw_to_input(WorkingMesh& mesh, const InputSurface& input, const TriangleTree& tree,
                            const std::vector<std::uint8_t>& is_fixed, std::span<const FarPlace> places,
                            double least_shape = kFairShape);

}  // namespace octafront::surface
