#pragma once

#include <filesystem>
#include <string>
#include <utility>

namespace octafront::cli {

struct Arguments;

/// "mm|cm|m|..." with `between` between them.
std::string names_of_units(const std::string& between);

/// A number and the unit behind it, which may be missing: "2.5mm" is 2.5 and "mm". Throws CLI::ValidationError under
/// the name of `option`.
std::pair<double, std::string> length_of(const std::string& option, const std::string& typed);

/// The unit that a file says its coordinates are in, or empty. Of the formats of surfaces only OBJ has a custom for it,
/// a comment "# File units = inches" near the beginning; STL, OFF and PLY have none.
std::string unit_of_file(const std::filesystem::path& file);

/// Turns lengths that were typed with a unit into the unit of the input: --unit, or else what the file says. Throws
/// OptionError if neither says anything.
void convert_lengths(Arguments& arguments);

}  // namespace octafront::cli
