#pragma once

#include "images/files/image_readers.h"

namespace octafront::image {

/// The same DICOM file written without compression as a whole, if it is deflated; else as it is. Throws InputError for
/// a damaged stream, LimitError for one that unpacks to more than the memory that there is.
KeptFile inflated(KeptFile file);

/// Whether this build unpacks pixels of the JPEG families.
bool has_gdcm();

/// The bytes of a DICOM file whose pixels are written by a JPEG family, again without compression (explicit, little
/// endian). Throws InputError if they are damaged. Requires has_gdcm().
KeptFile unpacked(const KeptFile& file);

}  // namespace octafront::image
