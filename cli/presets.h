#pragma once

#include "arguments.h"

namespace octafront::cli {

/// The options as given, with what the preset says of those that were not.
Options with_preset(const Arguments& arguments);

}  // namespace octafront::cli
