#include <octafront/error.h>

#include "images/nets/net_steps.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

namespace octafront::nets {

namespace {

// Distance of neighbouring voxels over the largest coordinate: some hundred doubles lie between two of them. With fewer
// the surfaces of the smallest bodies would have no room to be anything but steps.
constexpr double kLeastStep = 1e-13;

void refuse_lost_precision(const ImageGrid& grid) {
  double far = 0, step = HUGE_VAL;
  for (const Vec3& axis : grid.axes) step = std::min(step, length(axis));
  for (std::size_t k = 1; k < grid.slices.size(); ++k)
    step = std::min(step, (grid.slices[k] - grid.slices[k - 1]) * length(grid.axes[2]));
  for (int corner = 0; corner < 8; ++corner) {
    const double k = (corner & 4) != 0 ? grid.slice(grid.size[2] - 1) : grid.slice(0);
    const Vec3 p =
        grid.to_world({(corner & 1) != 0 ? grid.size[0] - 1.0 : 0, (corner & 2) != 0 ? grid.size[1] - 1.0 : 0, k});
    far = std::max({far, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  }
  if (step < kLeastStep * far)
    throw InputError(fmt::format(
        "neighbouring voxels are {:.3g} apart but lie {:.3g} away from the origin: double precision has too "
        "few points there to tell them apart. Move the image to the origin, or correct its header",
        step, far));
}

}  // namespace

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
  refuse_lost_precision(grid);
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

}  // namespace octafront::nets
