#pragma once

#include <octafront/options.h>

#include "io/input.h"

#include <vector>

namespace octafront {

/// Lines "x, y, z, size", separated by commas, semicolons or blanks, with or without a line of titles. Sizes are not
/// checked. Throws InputError with the line.
std::vector<PointSize> read_point_table(const io::Input& input);

}  // namespace octafront
