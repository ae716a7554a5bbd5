#include "images/files/tiff_pages.h"

namespace octafront::image {

bool has_tiff() {
  return false;
}

TiffPages tiff_pages(const io::Input& input) {
  input.fail(
      "is a TIFF file, which this octafront was built without; build it with libtiff-dev installed, or save the "
      "image as NRRD");
}

}  // namespace octafront::image
