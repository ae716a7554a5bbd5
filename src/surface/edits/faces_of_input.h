#pragma once

#include <octafront/options.h>

#include "surface/edits/walk.h"

#include <vector>

namespace octafront::surface {

/// Places where triangles of `made` turn by more than `degrees` against the input's surface, which is looked at where
/// their corners inside patches and their centroids lie, and the sizes that would do. `face` is an input face of each
/// vertex, `source` one of each triangle. Where the input is itself coarse, agreement with its face is enough.
std::vector<PointSize> turned_places(double degrees, const SurfaceMesh& made, const InputSurface& input,
                                     const SizeField& sizes, const std::vector<std::uint32_t>& face,
                                     const std::vector<std::uint8_t>& is_inner,
                                     const std::vector<std::uint32_t>& source);

/// Per triangle of `surface` the input triangle nearest to its centroid. `face` is per vertex an input face that it
/// lies in, `is_inner` whether it lies off all features: from such a vertex the input triangle is found by a short
/// walk; where there is none, or the walk strays, by a search.
std::vector<std::uint32_t> source_triangles(const InputSurface& input, const KnownSurface& original,
                                            const SurfaceMesh& surface, const std::vector<std::uint32_t>& face,
                                            const std::vector<std::uint8_t>& is_inner);

}  // namespace octafront::surface
