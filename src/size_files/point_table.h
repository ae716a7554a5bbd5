#pragma once

#include <octafront/options.h>

#include "io/input.h"

#include <vector>

namespace octafront {

/// Lines "x, y, z, size", separated by commas, semicolons or blanks, with or without a line of titles: words, not one
/// of them a number. Throws InputError with the line, also for sizes that are not above 0, or if there is no point.
std::vector<PointSize> read_point_table(const io::Input& input);

}  // namespace octafront
