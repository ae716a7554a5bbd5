#include <octafront/cad.h>
#include <octafront/image.h>
#include <octafront/limits.h>
#include <octafront/units.h>

#include "base/core/ascii.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace octafront {

namespace {

/// Of several images in a file all have the unit of the first.
std::string unit_of_image(const std::string& file) {
  const std::string unit = read_image(file, {1}).unit;
  return unit_named(unit) == nullptr ? "" : unit;
}

std::string beginning_of(const std::string& file) {
  constexpr std::size_t kBeginning = 4096;
  std::string text(kBeginning, '\0');
  require_in_folders(file);
  std::ifstream in(std::filesystem::path(file), std::ios::binary);
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  std::transform(text.begin(), text.end(), text.begin(), io::to_lower);
  return text;
}

}  // namespace

std::string unit_of_file(const std::string& file) {
  std::error_code error;
  if (is_image(file)) return unit_of_image(file);
  if (is_cad(file)) return "mm";
  if (!std::filesystem::is_regular_file(file, error)) return {};
  constexpr std::string_view kWords = "file units =";
  std::istringstream lines(beginning_of(file));
  for (std::string line; std::getline(lines, line);) {
    const std::size_t at = line.find(kWords);
    if (line.empty() || line[0] != '#' || at == std::string::npos) continue;
    const LengthUnit* unit = unit_named(std::string(io::trimmed(std::string_view(line).substr(at + kWords.size()))));
    return unit == nullptr ? "" : std::string(unit->name);
  }
  return {};
}

}  // namespace octafront
