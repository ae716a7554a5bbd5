#include "images/files/dicom/unpack.h"

namespace octafront::image {

bool has_gdcm() {
  return false;
}

KeptFile unpacked(const KeptFile& file) {
  return file;
}

}  // namespace octafront::image
