#pragma once

#include "line_options.h"

#include <vector>

namespace octafront::cli {

/// What makes the output a job of a solver. Options of one thing each are a file of that thing.
std::vector<LineOption> job_options();

}  // namespace octafront::cli
