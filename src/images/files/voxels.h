#pragma once

#include <octafront/image.h>

#include "formats/containers/input.h"
#include "images/files/byte_source.h"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace octafront::image {

/// How files store a voxel.
enum class VoxelType { kInt8, kUInt8, kInt16, kUInt16, kInt32, kUInt32, kInt64, kUInt64, kFloat32, kFloat64 };

std::uint64_t bytes_of(VoxelType type);
bool is_integer(VoxelType type);

/// Throws LimitError, before anything is unpacked, if this many stored voxels take more memory than there is.
void require_memory_for(const io::Input& input, std::uint64_t voxels, VoxelType type);

/// The bytes of voxels: value = slope * stored + intercept.
struct StoredVoxels {
  VoxelType type = VoxelType::kUInt8;
  bool big_endian = false;
  double slope = 1, intercept = 0;
};

/// Values of bytes; those behind the last whole voxel are passed over. Whole numbers stay whole, in the smallest type
/// that is good for all of them; where there is none, and for other slopes, they become single precision, which a note
/// says if it changed any. What is not finite becomes the least or largest value, with a note.
Image::Values values_of(std::string_view bytes, const StoredVoxels& stored, std::vector<std::string>& notes);

/// The same values in the smallest type that is good for all of them.
Image::Values narrowed(const std::vector<std::int32_t>& values, std::vector<std::string>& notes);

/// The same of values that are numbers already, as texts have them.
Image::Values values_of(const std::vector<double>& numbers, VoxelType type, std::vector<std::string>& notes);

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
