#include "base/places/places.h"

#include <algorithm>

namespace octafront {
namespace {

bool is_number(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

/// "A|B#2" of "A|B".
bool is_piece(std::string_view given, std::string_view name) {
  return given.starts_with(name) && given.substr(name.size()).starts_with('#') &&
         is_number(given.substr(name.size() + 1));
}

/// "B|A" of "A|B"; empty: it names no two.
std::string other_way_round(std::string_view name) {
  const std::size_t bar = name.find('|');
  if (bar == name.npos || name.find('|', bar + 1) != name.npos) return "";
  return std::string(name.substr(bar + 1)) + "|" + std::string(name.substr(0, bar));
}

std::vector<std::uint32_t> named_as_written(const std::vector<std::string>& names, const std::string& name) {
  constexpr std::string_view kFirst = "#1";
  const auto those = [&](const auto& is_meant) {
    std::vector<std::uint32_t> numbers;
    for (std::uint32_t i = 0; i < names.size(); ++i)
      if (is_meant(names[i])) numbers.push_back(i);
    return numbers;
  };
  if (name.empty()) return {};
  auto found = those([&](const std::string& n) { return n == name || is_piece(n, name); });
  if (found.empty() && name.ends_with(kFirst))
    found = those([&](const std::string& n) { return n == name.substr(0, name.size() - kFirst.size()); });
  if (found.empty()) found = those([&](const std::string& n) { return n.starts_with(name + " ("); });
  return found;
}

}  // namespace

std::vector<std::uint32_t> named_so(const std::vector<std::string>& names, const std::string& name) {
  std::vector<std::uint32_t> found = named_as_written(names, name);
  return found.empty() ? named_as_written(names, other_way_round(name)) : found;
}

std::string alone(const std::vector<std::string>& names, const std::string& name) {
  return std::ranges::any_of(names, [&](const std::string& n) { return is_piece(n, name); }) ? name + "#1" : name;
}

}  // namespace octafront
