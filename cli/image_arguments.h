#pragma once

#include <octafront/domain.h>

#include "line_options.h"

#include <array>
#include <string>
#include <vector>

namespace octafront::cli {

/// Those of images that no row of the tables has.
std::vector<LineOption> image_line_options();

/// "[NAME=]LO:HI", one end may be missing. Throws CLI::ValidationError.
GreyBand grey_band(const std::string& typed);
/// "3,4=cortex". Throws CLI::ValidationError.
LabelMerge label_merge(const std::string& typed);
/// "10:200,:,5:60". Throws CLI::ValidationError.
std::array<VoxelRange, 3> voxel_ranges(const std::string& typed);

}  // namespace octafront::cli
