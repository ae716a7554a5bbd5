#pragma once

#include "session.h"

namespace octafront::cli {

/// What an image is: grid, place, kind, and how often each label or value occurs.
void tell_image_info(Session& session);

}  // namespace octafront::cli
