#pragma once

#include <octafront/options.h>

#include <filesystem>
#include <vector>

namespace octafront {

/// Reads regions of refinement from a JSON file,
///   [{"box": [[0, 0, 0], [1, 2, 1]], "size": 0.1}, {"sphere": [5, 0, 0], "radius": 2, "size": 0.2},
///    {"point": [1, 1, 1], "size": 0.05}]
/// each optionally with "radius", or from a table of points, a line "x, y, z, size" each, separated by commas,
/// semicolons or blanks, with or without a line of titles. Throws InputError with the place and the reason.
std::vector<SizeRegion> read_size_regions(const std::filesystem::path& file);

}  // namespace octafront
