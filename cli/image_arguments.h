#pragma once

#include <octafront/domain.h>

#include <CLI/CLI.hpp>
#include <array>
#include <string>

namespace octafront::cli {

/// --series alone, for commands that only look.
void declare_image_choice(CLI::App& command, ImageIntake& image);
/// All of them.
void declare_image(CLI::App& command, ImageIntake& image);

/// "[NAME=]LO:HI", one end may be missing. Throws CLI::ValidationError.
GreyBand grey_band(const std::string& typed);
/// "3,4=cortex". Throws CLI::ValidationError.
LabelMerge label_merge(const std::string& typed);
/// "10:200,:,5:60". Throws CLI::ValidationError.
std::array<VoxelRange, 3> voxel_ranges(const std::string& typed);

}  // namespace octafront::cli
