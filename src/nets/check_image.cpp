#include "nets/check_image.h"

#include <octafront/error.h>

#include <cmath>

#include <fmt/core.h>

namespace octafront::nets {

void check_grid(const ImageGrid& grid, std::size_t voxels) {
  constexpr std::uint32_t kLongest = 1u << 30;
  for (const std::uint32_t n : grid.size)
    if (n == 0 || n > kLongest) throw InputError(fmt::format("the image has {} voxels along an axis", n));
  if (voxels != grid.voxels())
    throw InputError(fmt::format("{} values are given for {} voxels", voxels, grid.voxels()));
  if (!grid.slices.empty() && grid.slices.size() != grid.size[2])
    throw InputError(fmt::format("{} places are given for {} slices", grid.slices.size(), grid.size[2]));
  for (std::size_t k = 1; k < grid.slices.size(); ++k)
    if (!(grid.slices[k] > grid.slices[k - 1]))
      throw InputError(fmt::format("slice {} does not lie behind the one before it", k));
  const double volume = dot(cross(grid.axes[0], grid.axes[1]), grid.axes[2]);
  if (!is_finite(grid.origin) || !std::isfinite(volume) || volume == 0)
    throw InputError("the axes of the image do not span space: look at its affine map");
}

void check_labels(const LabelImage& image) {
  bool any = false;
  for (const std::uint16_t r : image.regions) {
    if (r == LabelImage::kNoRegion) continue;
    any = true;
    if (r >= image.labels.size())
      throw InputError(fmt::format("a voxel has label {}, but there are only {}", r, image.labels.size()));
  }
  if (!any) throw InputError("no voxel has a label that is to be meshed");
}

std::vector<std::string> names_of(const LabelImage& image) {
  std::vector<std::string> names;
  for (const LabelImage::Label& label : image.labels) names.push_back(label.name);
  return names;
}

}  // namespace octafront::nets
