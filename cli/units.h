#pragma once

#include <string>
#include <utility>

namespace octafront::cli {

struct Arguments;

/// "mm|cm|m|..." with `between` between them.
std::string names_of_units(const std::string& between);

/// A number and the unit behind it, which may be missing: "2.5mm" is 2.5 and "mm". Throws CLI::ValidationError under
/// the name of `option`.
std::pair<double, std::string> length_of(const std::string& option, const std::string& typed);

/// Turns lengths that were typed with a unit into the unit of the input: --unit, or else what the file says. Throws
/// OptionError if neither says anything.
void convert_lengths(Arguments& arguments);

}  // namespace octafront::cli
