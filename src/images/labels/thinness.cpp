#include "images/labels/label_steps.h"

#include <array>
#include <cstddef>

namespace octafront::image {

Thinness thinness_of(const LabelImage& image) {
  const auto& [ni, nj, nk] = image.grid.size;
  const std::array<std::size_t, 3> stride = {1, ni, static_cast<std::size_t>(ni) * nj};
  Thinness result;
  std::size_t v = 0;
  for (std::uint32_t k = 0; k < nk; ++k)
    for (std::uint32_t j = 0; j < nj; ++j)
      for (std::uint32_t i = 0; i < ni; ++i, ++v) {
        const std::uint16_t here = image.regions[v];
        const std::array<std::uint32_t, 3> at = {i, j, k};
        for (std::size_t axis = 0; axis < 3; ++axis) {
          if (at[axis] == 0 || image.regions[v - stride[axis]] == here) continue;
          ++result.faces;
          result.thin += at[axis] + 1 < image.grid.size[axis] && image.regions[v + stride[axis]] != here ? 1 : 0;
        }
      }
  return result;
}

}  // namespace octafront::image
