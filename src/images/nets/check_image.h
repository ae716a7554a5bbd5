#pragma once

#include <octafront/image.h>

#include <cstddef>

namespace octafront::nets {

/// Throws InputError if a grid with so many voxels makes no sense, or lies where double precision cannot tell them
/// apart.
void check_grid(const ImageGrid& grid, std::size_t voxels);

/// Throws InputError for labels that are not there, or if there is none.
void check_labels(const LabelImage& image);

}  // namespace octafront::nets
