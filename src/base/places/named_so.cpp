#include <octafront/split.h>

#include "base/places/places.h"

#include <algorithm>
#include <utility>

#include <fmt/core.h>

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

std::array<std::string, 2> names_of_sides(const std::string& name, const std::string& a, const std::string& b) {
  const std::array<std::string, 2> pairs{a + "|" + b, b + "|" + a};
  for (const std::string& pair : pairs) {
    const std::size_t at = name.find(pair);
    if (at == name.npos) continue;
    const std::string before = name.substr(0, at), behind = name.substr(at + pair.size());
    if ((before.empty() && (behind.empty() || is_piece(name, pair))) || (before.ends_with('(') && behind == ")"))
      return {before + pairs[0] + behind, before + pairs[1] + behind};
  }
  if (name.empty()) return pairs;
  return {name + " (" + pairs[0] + ")", name + " (" + pairs[1] + ")"};
}

std::vector<std::string> other_sides(const std::string& patch) {
  std::vector<std::string> others;
  for (const auto& [end, other] :
       {std::pair<std::string_view, std::string_view>{"_plus", "_minus"}, {"_minus", "_plus"}})
    if (patch.ends_with(end)) others.push_back(patch.substr(0, patch.size() - end.size()) + std::string(other));
  const std::size_t bracket = patch.ends_with(')') ? patch.rfind('(') : patch.npos;
  const std::string before = bracket == patch.npos ? "" : patch.substr(0, bracket + 1);
  const std::string pair = patch.substr(before.size(), patch.size() - before.size() - (before.empty() ? 0 : 1));
  const auto swap = [&](std::string_view sides, const std::string& behind) {
    for (std::size_t bar = sides.find('|'); bar != sides.npos; bar = sides.find('|', bar + 1))
      others.push_back(fmt::format("{}{}|{}{}", before, sides.substr(bar + 1), sides.substr(0, bar), behind));
  };
  swap(pair, before.empty() ? "" : ")");
  const std::size_t piece = pair.rfind('#');
  if (before.empty() && piece != pair.npos && is_number(pair.substr(piece + 1)))
    swap(std::string_view(pair).substr(0, piece), pair.substr(piece));
  return others;
}

bool is_made_later(const std::string& name) {
  const std::size_t dot = name.rfind('.');
  if (is_number(name) || (dot != name.npos && is_number(std::string_view(name).substr(dot + 1)))) return true;
  return name.starts_with("patch_") || name.starts_with("body_") || name.starts_with("curve_") ||
         name.ends_with("_plus") || name.ends_with("_minus");
}

std::string without_sides(const std::string& name) {
  return other_sides(name).empty() || !name.ends_with(')') ? name : name.substr(0, name.rfind(" ("));
}

std::string alone(const std::vector<std::string>& names, const std::string& name) {
  return std::ranges::any_of(names, [&](const std::string& n) { return is_piece(n, name); }) ? name + "#1" : name;
}

}  // namespace octafront
