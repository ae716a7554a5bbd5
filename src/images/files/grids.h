#pragma once

#include <octafront/image.h>

#include "formats/containers/input.h"
#include "images/files/byte_source.h"
#include "images/files/voxels.h"

#include <array>
#include <cstdint>
#include <string>

namespace octafront::image {

/// Sizes of an image as a file claims them.
using Sizes = std::array<std::int64_t, 3>;

/// The sizes of a grid. Throws InputError for what no image has: fewer than one voxel along an axis, or more in all
/// than can be numbered.
std::array<std::uint32_t, 3> checked_sizes(const io::Input& input, const Sizes& claimed);

/// The voxels of `sizes`, from the bytes that come. Throws InputError, before anything is allocated if they cannot all
/// come.
Image::Values read_voxels(ByteSource& source, const std::array<std::uint32_t, 3>& sizes, const StoredVoxels& stored,
                          std::vector<std::string>& notes);

/// Numbers of voxels as a text has them, from `at` in `input` on.
Image::Values read_text_voxels(const io::Input& input, const char* at, const std::array<std::uint32_t, 3>& sizes,
                               VoxelType type, std::vector<std::string>& notes);

/// Throws InputError unless indices map to the world and back: finite numbers, no axis without length, none that lies
/// in the plane of the others.
void check_grid(const io::Input& input, const ImageGrid& grid);

/// Throws InputError: an image of fewer than three dimensions.
[[noreturn]] void fail_flat(const io::Input& input);

/// "2 x 3 x 4"
std::string in_words(const std::array<std::uint32_t, 3>& sizes);

}  // namespace octafront::image
