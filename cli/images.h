#pragma once

#include <octafront/image.h>
#include <octafront/io.h>

#include "session.h"

namespace octafront::cli {

/// Whether the input of a command is an image. Throws OptionError for options of images beside an input that is none.
bool is_image_input(const Arguments& arguments);

/// Reads the input as an image, cropped and resampled as asked; what reading has to say is said. Throws InputError.
Image read_image_input(Session& session);

/// Makes a complex of an image by its labels or bands, and says what regions it has. Throws InputError, naming the
/// file; OptionError.
SurfaceFile read_image_domain(Session& session);

/// What an image is: grid, place, kind, and how often each label or value occurs.
void tell_image_info(Session& session);

}  // namespace octafront::cli
