#pragma once

#include <octafront/image_surface.h>

#include <vector>

namespace octafront::nets {

/// The image with bands cleaned as labels are, and values that say the same, so that its surface still lies between
/// voxels: those that changed lie in their new band, as near to their old value as that allows. Its notes are those of
/// cleaning.
Image cleaned_bands(const Image& image, const std::vector<GreyBand>& bands, const CleanOptions& clean,
                    const RunContext& context);

}  // namespace octafront::nets
