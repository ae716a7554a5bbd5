#pragma once

#include <octafront/image.h>

#include "formats/containers/input.h"
#include "images/files/dicom/slices.h"

namespace octafront::image {

/// A DICOM segmentation (PS3.3, A.51) as an image of labels: a voxel has the number of its segment, of several the
/// last; of segments of parts of voxels those that have half of it or more. Names are those of the segments. Throws
/// InputError for frames that make no volume.
Image read_segmentation(const io::Input& input, const SliceFile& file);

}  // namespace octafront::image
