#include <octafront/error.h>

#include "base/core/doubles.h"
#include "base/core/wording.h"
#include "base/places/places.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

namespace octafront {
namespace {

/// Names that a message lists at most, of each kind.
constexpr std::size_t kMostListed = 12;

std::vector<std::string> split_at(std::string_view text, char separator) {
  std::vector<std::string> words(1);
  for (const char c : text)
    if (c == separator)
      words.emplace_back();
    else
      words.back() += c;
  return words;
}

/// The numbers of "box:1,2,..." behind its colon.
std::vector<double> numbers_of(std::string_view option, const std::string& text, std::size_t count) {
  std::vector<double> numbers;
  for (const std::string& word : split_at(std::string_view(text).substr(text.find(':') + 1), ',')) {
    const std::size_t begin = std::min(word.find_first_not_of(' '), word.size());
    double value = 0;
    const auto [stop, error] = io::double_from_chars(word.data() + begin, word.data() + word.size(), value);
    if (error != std::errc() || stop != word.data() + word.size() || !std::isfinite(value))
      throw OptionError(fmt::format("`{}`: \"{}\" has \"{}\" where a number should be", option, text, word));
    numbers.push_back(value);
  }
  if (numbers.size() != count)
    throw OptionError(
        fmt::format("`{}`: \"{}\" has {} where {} numbers should be; places in space are box:X0,Y0,Z0,X1,Y1,Z1 and "
                    "sphere:X,Y,Z,R",
                    option, text, counted(numbers.size(), "number"), count));
  return numbers;
}

Box3 box_of(std::string_view option, const std::string& text) {
  const std::vector<double> n = numbers_of(option, text, 6);
  Box3 box;
  box.add(Vec3{n[0], n[1], n[2]}), box.add(Vec3{n[3], n[4], n[5]});
  return box;
}

GroupRule::Sphere ball_of(std::string_view option, const std::string& text) {
  const std::vector<double> n = numbers_of(option, text, 4);
  if (!(n[3] > 0)) throw OptionError(fmt::format("`{}`: \"{}\" has a radius that is not above 0", option, text));
  return {{n[0], n[1], n[2]}, n[3]};
}

/// How many of the words from `first` on are one place.
std::size_t words_of_place(const std::vector<std::string>& words, std::size_t first, char separator,
                           std::span<const std::string> known) {
  if (separator == ',') {
    const std::string& word = words[first];
    const std::size_t wanted = word.starts_with("box:") ? 6 : word.starts_with("sphere:") ? 4 : 1;
    if (wanted > 1) return std::min(wanted, words.size() - first);
  }
  for (std::size_t count = words.size() - first; count > 1; --count) {
    std::string name = words[first];
    for (std::size_t i = 1; i < count; ++i) name += separator + words[first + i];
    if (std::ranges::find(known, name) != known.end()) return count;
  }
  return 1;
}

}  // namespace

Place place_of(std::string_view option, const std::string& text) {
  constexpr std::string_view kPatches = "patches:";
  if (text.starts_with("box:")) return {text, box_of(option, text)};
  if (text.starts_with("sphere:")) return {text, ball_of(option, text)};
  if (text.starts_with(kPatches)) return {text, split_at(std::string_view(text).substr(kPatches.size()), ',')};
  return {text, text};
}

std::vector<Place> places_listed(std::string_view option, const std::string& list, char separator,
                                 std::span<const std::string> known) {
  const std::vector<std::string> words = split_at(list, separator);
  std::vector<Place> places;
  for (std::size_t i = 0, count = 0; i < words.size(); i += count) {
    count = words_of_place(words, i, separator, known);
    std::string text = words[i];
    for (std::size_t k = 1; k < count; ++k) text += separator + words[i + k];
    if (!text.empty()) places.push_back(place_of(option, text));
  }
  return places;
}

std::string patch_label(const std::vector<std::string>& names, std::uint32_t patch) {
  return patch < names.size() && !names[patch].empty() ? names[patch] : fmt::format("patch_{}", patch + 1);
}

std::vector<std::uint32_t> patches_called(const std::vector<std::string>& names, const std::vector<char>& is_there,
                                          const std::string& name) {
  std::vector<std::string> there(is_there.size());  // what is not there has no name
  for (std::uint32_t p = 0; p < is_there.size(); ++p)
    if (is_there[p] && p < names.size()) there[p] = names[p];
  if (name.empty()) return {};
  std::vector<std::uint32_t> patches = named_so(there, name);
  for (std::uint32_t p = 0; p < is_there.size() && patches.empty(); ++p)
    if (is_there[p] && (name == std::to_string(p + 1) || (there[p].empty() && name == patch_label(names, p))))
      patches.push_back(p);
  return patches;
}

std::vector<std::uint32_t> patches_called(std::string_view option, const std::vector<std::string>& names,
                                          const std::vector<char>& is_there, const std::string& name) {
  std::vector<std::uint32_t> patches = patches_called(names, is_there, name);
  if (!patches.empty()) return patches;
  std::vector<std::string> there;
  for (std::uint32_t p = 0; p < is_there.size(); ++p)
    if (is_there[p]) there.push_back(patch_label(names, p));
  throw OptionError(fmt::format("`{}`: {}", option, no_such_place(name, {{"patch", there}})));
}

std::string no_such_place(const std::string& name, const std::vector<NamesOfKind>& there) {
  std::string kinds, lists;
  bool are_many = false;  // of the kind that is listed first
  for (const auto& [kind, names] : there) {
    const bool is_last = kind == there.back().kind;
    kinds += (kinds.empty() ? "" : is_last ? " or " : ", ") + std::string(kind);
    if (names.empty()) continue;
    if (lists.empty()) are_many = names.size() > 1;
    lists += fmt::format("{}{}", lists.empty() ? "" : "; ",
                         noun(names.size(), std::string(kind), kind == "patch" ? "patches" : ""));
    for (std::size_t i = 0; i < std::min(kMostListed, names.size()); ++i)
      lists += fmt::format("{} \"{}\"", i == 0 ? "" : ",", names[i]);
    if (names.size() > kMostListed) lists += ", ...";
  }
  return fmt::format("there is no {} \"{}\"; {}", kinds, name,
                     lists.empty() ? "there is none" : (are_many ? "there are " : "there is ") + lists);
}

}  // namespace octafront
