#include "images/nets/lattice.h"

#include <cmath>

namespace octafront::nets {

Lattice::Lattice(const ImageGrid& grid, std::span<const Label> labels, const std::array<std::uint32_t, 3>& margin)
    : grid_(grid),
      labels_(labels),
      size_{static_cast<std::int32_t>(grid.size[0]), static_cast<std::int32_t>(grid.size[1]),
            static_cast<std::int32_t>(grid.size[2])},
      margin_{static_cast<std::int32_t>(margin[0]), static_cast<std::int32_t>(margin[1]),
              static_cast<std::int32_t>(margin[2])},
      step_{length(grid.axes[0]), length(grid.axes[1]), length(grid.axes[2])} {
  for (int axis = 0; axis < 3; ++axis) {
    const std::int32_t n = size_[axis];
    std::vector<double>& middle = middle_[axis];
    middle.resize(static_cast<std::size_t>(n) + 2);
    if (margin_[axis] > 0) {
      place_halves(axis);
      continue;
    }
    for (std::int32_t i = 0; i < n; ++i)
      middle[i + 1] = step_[axis] * (axis == 2 ? grid.slice(static_cast<std::uint32_t>(i)) : i);
    const double first = n > 1 ? middle[2] - middle[1] : step_[axis], last = n > 1 ? middle[n] - middle[n - 1] : first;
    middle[0] = middle[1] - first;
    middle[n + 1] = middle[n] + last;
    for (std::int32_t c = 0; c <= n; ++c) wall_[axis].push_back((middle[c] + middle[c + 1]) / 2);
  }
}

/// The layers on both sides of the cell's ends are half as high as others; the low end is the middle of voxel 0.
void Lattice::place_halves(int axis) {
  const std::int32_t n = size_[axis], m = margin_[axis];
  const auto wall = [&](std::int32_t c) {  // in voxels
    const double from_low = c - m, beyond = n - m - c;
    if (c == m) return 0.0;
    if (c < m) return from_low + 0.5;
    if (c == n - m) return n - 2.0 * m - 1;
    return beyond > 0 ? from_low - 0.5 : from_low - 1.5;
  };
  for (std::int32_t c = 0; c <= n; ++c) wall_[axis].push_back(step_[axis] * wall(c));
  std::vector<double>& middle = middle_[axis];
  for (std::int32_t i = 0; i < n; ++i) middle[i + 1] = (wall_[axis][i] + wall_[axis][i + 1]) / 2;
  middle[0] = middle[1] - step_[axis], middle[n + 1] = middle[n] + step_[axis];
}

Vec3 Lattice::to_world(Vec3 p) const {
  return grid_.to_world({p.x / step_.x, p.y / step_.y, p.z / step_.z});
}

Vec3 Lattice::to_straight(Vec3 world) const {
  const Vec3 index = grid_.to_index(world);
  return {index.x * step_.x, index.y * step_.y, index.z * step_.z};
}

bool Lattice::is_mirrored() const {
  return dot(cross(grid_.axes[0], grid_.axes[1]), grid_.axes[2]) < 0;
}

double Lattice::volume_scale() const {
  return std::abs(dot(cross(grid_.axes[0], grid_.axes[1]), grid_.axes[2])) / (step_.x * step_.y * step_.z);
}

}  // namespace octafront::nets
