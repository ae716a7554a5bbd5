#include "images/nets/lattice.h"

#include <cmath>

namespace octafront::nets {

Lattice::Lattice(const ImageGrid& grid, std::span<const Label> labels)
    : grid_(grid),
      labels_(labels),
      size_{static_cast<std::int32_t>(grid.size[0]), static_cast<std::int32_t>(grid.size[1]),
            static_cast<std::int32_t>(grid.size[2])},
      step_{length(grid.axes[0]), length(grid.axes[1]), length(grid.axes[2])} {
  for (int axis = 0; axis < 3; ++axis) {
    const std::int32_t n = size_[axis];
    std::vector<double>& middle = middle_[axis];
    middle.resize(static_cast<std::size_t>(n) + 2);
    for (std::int32_t i = 0; i < n; ++i)
      middle[i + 1] = step_[axis] * (axis == 2 ? grid.slice(static_cast<std::uint32_t>(i)) : i);
    const double first = n > 1 ? middle[2] - middle[1] : step_[axis], last = n > 1 ? middle[n] - middle[n - 1] : first;
    middle[0] = middle[1] - first;
    middle[n + 1] = middle[n] + last;
    for (std::int32_t c = 0; c <= n; ++c) wall_[axis].push_back((middle[c] + middle[c + 1]) / 2);
  }
}

Vec3 Lattice::to_world(Vec3 p) const {
  return grid_.to_world({p.x / step_.x, p.y / step_.y, p.z / step_.z});
}

bool Lattice::is_mirrored() const {
  return dot(cross(grid_.axes[0], grid_.axes[1]), grid_.axes[2]) < 0;
}

double Lattice::volume_scale() const {
  return std::abs(dot(cross(grid_.axes[0], grid_.axes[1]), grid_.axes[2])) / (step_.x * step_.y * step_.z);
}

}  // namespace octafront::nets
