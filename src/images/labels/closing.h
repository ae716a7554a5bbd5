#pragma once

#include <octafront/image.h>
#include <octafront/run_context.h>

#include <cstdint>

namespace octafront::image {

/// The morphological closing of each region by an octahedron of `reach` voxels, into the outside only; voxels that
/// several regions close over go to the first one. Returns how many voxels were taken.
std::uint64_t close_gaps(LabelImage& image, std::uint32_t reach, const RunContext& context);

}  // namespace octafront::image
