#pragma once

#include "surface/edits/walk.h"

namespace octafront::surface {

/// Per triangle of `surface` the input triangle nearest to its centroid. `face` is per vertex an input face that it
/// lies in, `is_inner` whether it lies off all features: from such a vertex the input triangle is found by a short
/// walk; where there is none, or the walk strays, by a search.
std::vector<std::uint32_t> source_triangles(const InputSurface& input, const KnownSurface& original,
                                            const SurfaceMesh& surface, const std::vector<std::uint32_t>& face,
                                            const std::vector<std::uint8_t>& is_inner);

}  // namespace octafront::surface
