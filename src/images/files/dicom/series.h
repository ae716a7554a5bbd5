#pragma once

#include <octafront/image.h>

#include "formats/containers/input.h"
#include "images/files/dicom/slices.h"
#include "images/files/image_readers.h"

#include <functional>
#include <string>
#include <vector>

namespace octafront::image {

/// A DICOM segmentation (PS3.3, A.51) as an image of labels: a voxel has the number of its segment, of several the
/// last; of segments of parts of voxels those that have half of it or more. Names are those of the segments. Throws
/// InputError for frames that make no volume.
Image read_segmentation(const io::Input& input, const SliceFile& file);

/// Files by number, opened when they are needed.
struct SliceFiles {
  std::vector<std::string> names;
  std::function<KeptFile(std::size_t file)> open;
  bool skip_others = false;  ///< of a folder: what is no image is passed over
};

/// The volume of the slices of many files; of several the one that was chosen. Throws InputError with a list of them if
/// none was, for slices that make no volume, and for pixels that are not read here.
Image read_series(const SliceFiles& files, const ImageChoice& choice, const RunContext& context);

/// Of one file.
Image read_dicom(const Reading& reading);

/// The DICOM files in a folder and those inside it, in order of their names.
std::vector<std::string> dicom_files_in(const std::string& folder, const RunContext& context);

}  // namespace octafront::image
