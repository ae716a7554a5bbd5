#pragma once

// The readers of sizes, from bytes in memory. All throw InputError.

#include "formats/containers/input.h"
#include "formats/parts/raw_mesh.h"

#include <string>
#include <vector>

namespace octafront {

/// Lines "x, y, z, size", separated by commas, semicolons or blanks, with or without a line of titles: words, not one
/// of them a number. Refuses sizes that are not above 0, with their line, and a table without a point.
std::vector<PointSize> read_point_table(const io::Input& input);

/// Recognise and read: as the readers of files in octafront/io.h.
std::vector<PointSize> read_point_sizes_bytes(const io::Input& input);
std::vector<SizeRegion> read_size_regions_bytes(const io::Input& input);
SizeMesh read_size_mesh_bytes(const io::Input& input, const std::string& field);
/// The mesh with the field that Input::field asks for, also where that stands in a file beside.
io::RawMesh read_with_field(const io::Input& input);
SizeField read_size_field_bytes(const io::Input& input, double gradation);

}  // namespace octafront
