#include "units.h"

#include <octafront/error.h>
#include <octafront/image.h>

#include "arguments.h"

#include <array>
#include <cmath>
#include <fstream>
#include <string_view>

#include <fmt/core.h>

namespace octafront::cli {

namespace {

struct Unit {
  std::string_view name;
  double metres;
  std::string_view words;  ///< by which files call it
};

constexpr std::array kUnits{Unit{"um", 1e-6, " micrometers micrometres microns micron "},
                            Unit{"mm", 1e-3, " millimeters millimetres millimeter millimetre "},
                            Unit{"cm", 1e-2, " centimeters centimetres centimeter centimetre "},
                            Unit{"m", 1, " meters metres meter metre "},
                            Unit{"in", 0.0254, " inches inch "},
                            Unit{"ft", 0.3048, " feet foot "}};

const Unit* unit_named(const std::string& name) {
  for (const Unit& unit : kUnits)
    if (unit.name == name || (!name.empty() && unit.words.find(" " + name + " ") != std::string_view::npos))
      return &unit;
  return nullptr;
}

/// Of several images in a file all have the unit of the first.
std::string unit_of_image(const std::filesystem::path& file) {
  const std::string unit = read_image(file, {1}).unit;
  return unit_named(unit) == nullptr ? "" : unit;
}

}  // namespace

std::string names_of_units(const std::string& between) {
  std::string names;
  for (const Unit& unit : kUnits) names += (names.empty() ? "" : between) + std::string(unit.name);
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

std::string unit_of_file(const std::filesystem::path& file) {
  std::error_code error;
  if (is_image(file)) return unit_of_image(file);
  if (!std::filesystem::is_regular_file(file, error)) return {};
  constexpr std::size_t kBeginning = 4096;
  constexpr std::string_view kWords = "file units =";
  std::string text(kBeginning, '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  for (const std::string& line : CLI::detail::split(CLI::detail::to_lower(text), '\n')) {
    const std::size_t at = line.find(kWords);
    if (line.empty() || line[0] != '#' || at == std::string::npos) continue;
    const Unit* unit = unit_named(CLI::detail::trim_copy(line.substr(at + kWords.size())));
    return unit == nullptr ? "" : std::string(unit->name);
  }
  return {};
}

void convert_lengths(Arguments& a) {
  a.unit = CLI::detail::to_lower(a.unit);
  if (!a.unit.empty() && unit_named(a.unit) == nullptr)
    throw OptionError(fmt::format("--unit is one of {}; \"{}\" is none of them", names_of_units(", "), a.unit));
  if (a.lengths.empty()) return;
  const std::string of_file = a.unit.empty() ? unit_of_file(a.input) : a.unit;
  for (const TypedLength& length : a.lengths) {
    if (of_file.empty())
      throw OptionError(
          fmt::format("{} {}{}: {} does not say what its coordinates count; add --unit mm, or whatever "
                      "they are, or give the length without a unit",
                      length.option, **length.value, length.unit, a.input.string()));
    *length.value = **length.value * unit_named(length.unit)->metres / unit_named(of_file)->metres;
  }
  a.unit = of_file;
}

}  // namespace octafront::cli
