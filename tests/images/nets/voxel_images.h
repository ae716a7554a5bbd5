#pragma once

// Images of known bodies, and noise.

#include <octafront/image.h>

#include <cstdint>
#include <functional>
#include <vector>

namespace octafront::testing {

/// Labels 0 ... n - 1 called "a", "b", ...; `label_at` says what the middle of a voxel is in, in the world; below 0: in
/// none.
LabelImage label_image(const ImageGrid& grid, int labels, const std::function<int(Vec3)>& label_at);
Image grey_image(const ImageGrid& grid, const std::function<double(Vec3)>& value_at);

/// A grid of such voxels, at right angles, whose box has its middle at the origin.
ImageGrid grid_around_origin(std::array<std::uint32_t, 3> size, Vec3 spacing);
/// The same, turned by degrees about an axis that is no one's.
ImageGrid turned(ImageGrid grid, double degrees);

/// Each voxel one of the labels or none, by chance.
LabelImage noise(std::array<std::uint32_t, 3> size, int labels, double density, std::uint64_t seed);

}  // namespace octafront::testing
