#pragma once

#include <octafront/image.h>

#include <functional>
#include <string>
#include <vector>

namespace octafront::image {

/// Several images of one grid, a mask each, as one image of labels: number 1 is the first file, by its name. What is
/// half or more belongs to a mask; a voxel of several to the last. Throws InputError for grids that differ.
Image image_of_masks(const std::vector<std::string>& files, const std::function<Image(const std::string&)>& read);

/// The images in a folder that are no DICOM, in order of their names; `is_one` tells them.
std::vector<std::string> images_in(const std::string& folder, const std::function<bool(const std::string&)>& is_one);

/// The layers of a segmentation whose segments overlap, and what its segments are called.
struct Layers {
  struct Segment {
    std::size_t layer = 0;
    std::int64_t value = 0;
    std::string name;
  };
  std::vector<Image::Values> values;
  std::vector<Segment> segments;
};
/// Number 1 is the first segment; a voxel of several belongs to the last.
void put_together(const Layers& layers, Image& image);

}  // namespace octafront::image
