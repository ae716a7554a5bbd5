#pragma once

#include "line_options.h"

#include <vector>

namespace octafront::cli {

/// Those of `octafront picture`.
std::vector<LineOption> picture_options();

}  // namespace octafront::cli
