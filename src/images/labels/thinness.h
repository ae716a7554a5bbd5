#pragma once

// How much of a segmentation is only a voxel thick.

#include <octafront/image.h>

#include <cstdint>

namespace octafront::image {

struct Thinness {
  std::uint64_t faces = 0;  ///< between voxels of different regions
  std::uint64_t thin = 0;   ///< voxels between two of them along an axis
  double part() const { return faces == 0 ? 0 : static_cast<double>(thin) / static_cast<double>(faces); }
};

/// Faces on the image's box do not count.
Thinness thinness_of(const LabelImage& image);

}  // namespace octafront::image
