#pragma once

#include "surface/edits/working_mesh.h"
#include "surface/ground/deviation.h"

#include <span>

namespace octafront::remeshing {

/// No new triangle is worse than this 2r/R, unless one was: what is mended for its shape strays again.
inline constexpr double kFairShape = 0.35;

/// Brings the mesh nearer to the input where it strays: each triangle that a place names, and that faces as the input
/// does there, gets the place's point of the input as a vertex: inside, on one of its edges, or as the new place of the
/// corner that is next to it; where none of these is sound an edge of it is halved, on the input; exactly without new
/// crossings. `tree` is over the input's triangles. Of several places at a triangle the farthest is taken, so
/// what is left must be looked for again. `triangle` of the places is a number of the mesh's; `is_fixed`: by vertex,
/// those stay, and those beyond its end need not. No new triangle has a 2r/R below `least_shape`, unless one had.
/// Returns the number of points put in.
std::uint64_t approach(WorkingMesh& mesh, const InputSurface& input, const TriangleTree& tree,
                       const std::vector<std::uint8_t>& is_fixed, std::span<const FarPlace> places,
                       double least_shape = kFairShape);

}  // namespace octafront::remeshing
