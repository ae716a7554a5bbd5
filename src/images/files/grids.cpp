#include "formats/containers/scanner.h"
#include "images/files/voxels.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

namespace octafront {

std::string in_words(const ImageGrid& grid) {
  return fmt::format("{} voxels of {:.6g} x {:.6g} x {:.6g}", image::in_words(grid.size), length(grid.axes[0]),
                     length(grid.axes[1]), length(grid.axes[2]));
}

}  // namespace octafront

namespace octafront::image {

std::string in_words(const std::array<std::uint32_t, 3>& sizes) {
  return fmt::format("{} x {} x {}", sizes[0], sizes[1], sizes[2]);
}

std::array<std::uint32_t, 3> checked_sizes(const io::Input& input, const Sizes& claimed) {
  // Voxels have numbers of 32 bits.
  constexpr std::int64_t kMost = 0xfffffffe;
  const std::string words = fmt::format("{} x {} x {} voxels", claimed[0], claimed[1], claimed[2]);
  std::int64_t voxels = 1;
  for (const std::int64_t n : claimed) {
    if (n < 1) input.fail(fmt::format("claims {}; the file is damaged: export it again", words));
    if (n > kMost / voxels)
      input.fail(fmt::format("claims {}, more than the {} that an image may have here; crop or resample it first",
                             words, kMost));
    voxels *= n;
  }
  return {static_cast<std::uint32_t>(claimed[0]), static_cast<std::uint32_t>(claimed[1]),
          static_cast<std::uint32_t>(claimed[2])};
}

Image::Values read_voxels(ByteSource& source, const std::array<std::uint32_t, 3>& sizes, const StoredVoxels& stored,
                          std::vector<std::string>& notes) {
  const std::uint64_t bytes = std::uint64_t{sizes[0]} * sizes[1] * sizes[2] * bytes_of(stored.type);
  if (bytes > source.most_bytes_left())
    source.fail(
        fmt::format("{} voxels take {} bytes, but {} {} can follow; the file is truncated or damaged: copy or "
                    "export it again",
                    in_words(sizes), bytes, source.is_packed() ? "at most" : "only", source.most_bytes_left()));
  require_memory_for(source.input(), bytes / bytes_of(stored.type), stored.type);
  return values_of(source.require(bytes, "the voxels"), stored, notes);
}

Image::Values read_text_voxels(const io::Input& input, const char* at, const std::array<std::uint32_t, 3>& sizes,
                               VoxelType type, std::vector<std::string>& notes) {
  io::Scanner scan(input);
  scan.set_position(at);
  const std::uint64_t voxels = std::uint64_t{sizes[0]} * sizes[1] * sizes[2];
  if (voxels > (scan.bytes_left() + 1) / 2)
    input.fail_at_byte(at, fmt::format("{} voxels take {} characters at least, but only {} can follow; the file is "
                                       "truncated or damaged: copy or export it again",
                                       in_words(sizes), 2 * voxels - 1, scan.bytes_left()));
  require_memory_for(input, voxels, VoxelType::kFloat64);
  std::vector<double> numbers(voxels);
  for (double& number : numbers) number = scan.number("the value of a voxel");
  return values_of(numbers, type, notes);
}

void fail_flat(const io::Input& input) {
  input.fail("is a flat image; a volume has three dimensions (its slices may be many files: give their folder)");
}

void check_grid(const io::Input& input, const ImageGrid& grid) {
  // Beyond this coordinates lose what sets voxels apart; repair draws the same line.
  constexpr double kMost = 1e50;
  const auto is_place = [](Vec3 p) {
    return is_finite(p) && std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) < kMost;
  };
  const Vec3 last{grid.size[0] - 1.0, grid.size[1] - 1.0, grid.slice(grid.size[2] - 1)};
  if (!is_place(grid.origin) || !is_place(grid.to_world(last)))
    input.fail("its voxels lie at no finite place; the header is damaged: export it again");
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 step = grid.axes[static_cast<std::size_t>(axis)];
    if (!is_place(step) || !(squared_length(step) > 0))
      input.fail(fmt::format("its voxels have no size along axis {}; give the spacing where it was exported", axis));
  }
  const double volume = dot(cross(grid.axes[0], grid.axes[1]), grid.axes[2]);
  const double largest = length(grid.axes[0]) * length(grid.axes[1]) * length(grid.axes[2]);
  // A quality bound: no gantry tilts so far, and what is flatter has lost its digits.
  constexpr double kFlat = 1e-6;
  if (!(std::abs(volume) > kFlat * largest))
    input.fail("the three axes of its voxels lie in one plane; the header is damaged: export it again");
}

}  // namespace octafront::image
