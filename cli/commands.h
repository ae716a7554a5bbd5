#pragma once

#include "arguments.h"

namespace octafront::cli {

/// The commands. Each returns the exit status; what goes wrong is thrown as an octafront::Error.
int run_mesh(const Arguments& arguments);
int run_surface(const Arguments& arguments);
int run_size(const Arguments& arguments);
int run_improve(const Arguments& arguments);
int run_check(const Arguments& arguments);

}  // namespace octafront::cli
