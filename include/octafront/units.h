#pragma once

#include <span>
#include <string>
#include <string_view>

namespace octafront {

/// A unit of length that a user may write behind a number.
struct LengthUnit {
  std::string_view name;  ///< "mm"
  double metres;
  std::string_view words;  ///< by which files call it, between blanks
};

std::span<const LengthUnit> length_units();

/// By its name or a word of files, in lower case; null if there is none.
const LengthUnit* unit_named(const std::string& name);

/// A density in kg/m3, in the units that go with newtons and this unit of length: 7850 is 7.85e-9 with mm (t/mm3).
double density_with_newtons(double kilograms_per_cubic_metre, const LengthUnit& unit);

/// The unit that a file says its coordinates are in, or empty. Images mostly say it; CAD comes in "mm" always; of the
/// formats of surfaces only OBJ has a custom for it, a comment "# File units = inches" near the beginning; STL, OFF and
/// PLY have none. Throws InputError for an image that cannot be read.
std::string unit_of_file(const std::string& file);

}  // namespace octafront
