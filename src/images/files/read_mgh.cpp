// FreeSurfer's .mgh, and .mgz, which is that packed by gzip: all numbers big endian, voxels behind a header of 284
// bytes. https://surfer.nmr.mgh.harvard.edu/fswiki/FsTutorial/MghFormat

#include "images/files/byte_source.h"
#include "images/files/image_readers.h"
#include "images/files/voxels.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <map>
#include <optional>

#include <fmt/core.h>

namespace octafront::image {
namespace {

constexpr std::size_t kMghHeader = 284;
constexpr std::size_t kPlaced = 28, kSpacing = 30, kDirections = 42, kMiddle = 78;  ///< where fields stand

template <class T>
T big_endian_at(std::string_view bytes, std::size_t at) {
  char raw[sizeof(T)];
  std::memcpy(raw, bytes.data() + at, sizeof(T));
  std::reverse(raw, raw + sizeof(T));
  return std::bit_cast<T>(raw);
}

std::int32_t word(std::string_view header, std::size_t n) {
  return big_endian_at<std::int32_t>(header, 4 * n);
}

std::optional<VoxelType> type_of_mgh(std::int32_t code) {
  static const std::map<std::int32_t, VoxelType> kTypes{{0, VoxelType::kUInt8},
                                                        {1, VoxelType::kInt32},
                                                        {3, VoxelType::kFloat32},
                                                        {4, VoxelType::kInt16},
                                                        {10, VoxelType::kUInt16}};
  const auto found = kTypes.find(code);
  return found == kTypes.end() ? std::nullopt : std::optional(found->second);
}

/// Where voxels lie: the header has the directions of the axes, and what the middle of the volume is in RAS.
void place(std::string_view header, ImageGrid& grid, std::vector<std::string>& notes) {
  if (big_endian_at<std::int16_t>(header, kPlaced) == 0) {
    notes.emplace_back("the header does not say where the volume lies; voxels of 1 mm, coronal, are taken");
    grid.axes = {{{-1, 0, 0}, {0, 0, -1}, {0, 1, 0}}};
  } else {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double step = big_endian_at<float>(header, kSpacing + 4 * axis);
      for (std::size_t c = 0; c < 3; ++c)
        grid.axes[axis][static_cast<int>(c)] = step * big_endian_at<float>(header, kDirections + 4 * (3 * axis + c));
      grid.origin[static_cast<int>(axis)] = big_endian_at<float>(header, kMiddle + 4 * axis);
    }
  }
  for (std::size_t axis = 0; axis < 3; ++axis) grid.origin = grid.origin - grid.axes[axis] * (grid.size[axis] / 2.0);
}

}  // namespace

bool is_mgh(std::string_view head) {
  if (head.size() < kMghHeader || word(head, 0) != 1 || !type_of_mgh(word(head, 5))) return false;
  const auto is_size = [&](std::size_t n) { return word(head, n) > 0 && word(head, n) <= 1 << 20; };
  const auto placed = big_endian_at<std::int16_t>(head, kPlaced);
  return is_size(1) && is_size(2) && is_size(3) && is_size(4) && (placed == 0 || placed == 1);
}

Image read_mgh(const Reading& reading) {
  ByteSource source(reading.input, 0, Packing::kDetect);
  const std::string header(source.require(kMghHeader, "the header"));
  Image image;
  image.format = source.is_packed() ? "FreeSurfer MGZ" : "FreeSurfer MGH";
  image.unit = "mm";
  image.frame = "RAS";
  image.grid.size = checked_sizes(reading.input, {word(header, 1), word(header, 2), word(header, 3)});
  place(header, image.grid, image.notes);
  check_grid(reading.input, image.grid);
  StoredVoxels stored;
  stored.type = type_of_mgh(word(header, 5)).value_or(VoxelType::kUInt8);  // is_mgh() has seen it
  stored.big_endian = true;
  const std::uint64_t frame = chosen_series(reading, static_cast<std::uint64_t>(word(header, 4)), "frames");
  source.skip(frame * image.grid.voxels() * bytes_of(stored.type), "the voxels");
  image.values = read_voxels(source, image.grid.size, stored, image.notes);
  return image;
}

}  // namespace octafront::image
