#pragma once

// Grey images whose details no mesh of automatic size can have.

#include <octafront/domain.h>
#include <octafront/image.h>

#include <optional>

namespace octafront::intake {

/// The image in coarser voxels, if ImageIntake::most_elements asks for it; its last note says what was given up.
std::optional<Image> coarsened_for_budget(const Image& image, const ImageIntake& asked, const ImageRegions& regions,
                                          const RunContext& context);

}  // namespace octafront::intake
