#include "units.h"

#include <octafront/error.h>
#include <octafront/option_table.h>
#include <octafront/units.h>

#include "arguments.h"

#include <fmt/core.h>

namespace octafront::cli {

std::string names_of_units(const std::string& between) {
  std::string names;
  for (const LengthUnit& unit : length_units()) names += (names.empty() ? "" : between) + std::string(unit.name);
  return names;
}

std::pair<double, std::string> length_of(const std::string& option, const std::string& typed) {
  std::size_t end = typed.size();
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  while (end > 0 && is_letter(typed[end - 1])) --end;
  const std::string unit = CLI::detail::to_lower(typed.substr(end));
  const bool is_word = end == 0 || unit == "e";  // "inf", "nan", "1e"
  double value = 0;
  const std::string digits = CLI::detail::trim_copy(typed.substr(0, is_word ? typed.size() : end));
  if (!CLI::detail::lexical_cast(digits, value))
    throw CLI::ValidationError(option, "\"" + typed + "\" is no length; write 2, or 2mm");
  if (is_word || unit.empty()) return {value, ""};
  if (unit_named(unit) == nullptr)
    throw CLI::ValidationError(option,
                               "\"" + typed + "\" has a unit that is not known; it is one of " + names_of_units(", "));
  return {value, unit};
}

void convert_lengths(Arguments& a) {
  a.unit = CLI::detail::to_lower(a.unit);
  if (!a.unit.empty() && unit_named(a.unit) == nullptr)
    throw OptionError(fmt::format("--unit is one of {}; \"{}\" is none of them", names_of_units(", "), a.unit));
  if (!a.unit.empty()) a.intake.cad.unit = unit_named(a.unit)->name;
  if (a.lengths.empty()) return;
  const std::string of_file = a.unit.empty() ? unit_of_file(a.input.string()) : a.unit;
  for (const TypedLength& length : a.lengths) {
    const double typed = std::get<double>(option_value(a.options, length.name));
    if (of_file.empty())
      throw OptionError(
          fmt::format("{} {}{}: {} does not say what its coordinates count; add --unit mm, or whatever "
                      "they are, or give the length without a unit",
                      length.option, typed, length.unit, a.input.string()));
    set_option(a.options, length.name, typed * unit_named(length.unit)->metres / unit_named(of_file)->metres);
  }
  a.unit = of_file;
}

}  // namespace octafront::cli
