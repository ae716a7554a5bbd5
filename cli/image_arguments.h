#pragma once

#include <octafront/image.h>
#include <octafront/image_surface.h>

#include <CLI/CLI.hpp>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace octafront::cli {

/// The first and the last voxel along an axis, both inside; without a value to the end.
using VoxelRange = std::pair<std::optional<std::uint32_t>, std::optional<std::uint32_t>>;

/// What the user typed about an image.
struct ImageArguments {
  ImageChoice choice;
  ImageRegions regions;         ///< but for the names of labels
  std::filesystem::path names;  ///< --labels; empty: none
  std::array<VoxelRange, 3> crop;
  bool crops = false;
  std::vector<double> spacing;     ///< --resample: one or three; empty: as it is
  std::vector<std::string> given;  ///< options that only images have, as they were typed
};

/// --series alone, for commands that only look.
void declare_image_choice(CLI::App& command, ImageArguments& image);
/// All of them.
void declare_image(CLI::App& command, ImageArguments& image);

/// "[NAME=]LO:HI", one end may be missing. Throws CLI::ValidationError.
GreyBand grey_band(const std::string& typed);
/// "3,4=cortex". Throws CLI::ValidationError.
LabelMerge label_merge(const std::string& typed);
/// "10:200,:,5:60". Throws CLI::ValidationError.
std::array<VoxelRange, 3> voxel_ranges(const std::string& typed);

}  // namespace octafront::cli
