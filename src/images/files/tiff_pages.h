#pragma once

#include <octafront/image.h>

#include "images/files/image_readers.h"
#include "images/files/voxels.h"

#include <array>
#include <string>
#include <vector>

namespace octafront::image {

/// The pages of a TIFF file, one upon the other.
struct TiffPages {
  std::array<std::int64_t, 3> size{0, 0, 0};
  StoredVoxels stored;
  std::array<double, 3> spacing{0, 0, 0};  ///< 0: the file does not say
  std::string unit;
  std::vector<char> bytes;
};

/// Whether this build reads TIFF.
bool has_tiff();
/// Throws InputError for colours, and pages that differ. Requires has_tiff().
TiffPages tiff_pages(const io::Input& input);

}  // namespace octafront::image
