#include <octafront/error.h>
#include <octafront/limits.h>

#include "base/core/doubles.h"
#include "doors/intake/intake.h"

#include <fstream>
#include <sstream>
#include <utility>

#include <fmt/format.h>

namespace octafront::intake {
namespace {

std::optional<ContactWay> way_called(const std::string& word) {
  for (const auto& [name, way] :
       {std::pair{"shared", ContactWay::kShared}, {"split", ContactWay::kSplit}, {"separate", ContactWay::kSeparate}})
    if (word == name) return way;
  return std::nullopt;
}

std::vector<std::string> divided_at(char separator, const std::string& text) {
  std::vector<std::string> words;
  std::istringstream in(text);
  for (std::string word; std::getline(in, word, separator);)
    if (!word.empty()) words.push_back(std::move(word));
  return words;
}

/// "A|B=split"; nullopt: it is no rule.
std::optional<ContactChoice::Rule> rule_in(const std::string& text) {
  const std::size_t equals = text.rfind('=');
  if (equals == text.npos || equals == 0) return std::nullopt;
  const auto way = way_called(text.substr(equals + 1));
  return way ? std::optional(ContactChoice::Rule{text.substr(0, equals), *way}) : std::nullopt;
}

/// One in each line; empty lines, and those that begin with #, say nothing.
void read_rules(const std::string& file, std::vector<ContactChoice::Rule>& rules) {
  require_in_folders(file);
  std::ifstream in(file);
  if (!in)
    throw OptionError(fmt::format(
        "`contact`: \"{}\" is neither CONTACT=shared, CONTACT=split or CONTACT=separate, nor a file of such lines",
        file));
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (line.ends_with('\r')) line.pop_back();
    if (line.empty() || line.starts_with('#')) continue;
    const auto rule = rule_in(line);
    if (!rule)
      throw InputError(
          fmt::format("{}, line {}: \"{}\" is not CONTACT=WAY, with shared, split or separate", file, number, line));
    rules.push_back(*rule);
  }
}

}  // namespace

std::optional<double> area_in(const std::string& text) {
  double area = -1;
  const char* const end = text.data() + text.size();
  const bool is_area = io::double_from_chars(text.data(), end, area).ptr == end && area >= 0;
  return is_area ? std::optional(area) : std::nullopt;
}

ContactsAsked contacts_asked(const IntakeOptions& options) {
  ContactsAsked asked;
  for (const std::string& word : divided_at(',', options.contacts)) {
    if (const auto way = way_called(word))
      asked.of_parts.all = *way;
    else if (word == "keep" || area_in(word))
      asked.of_labels = word;
    else
      throw OptionError(fmt::format(
          "`contacts` is \"{}\": give shared, split or separate; of an image also an area from 0 on, or keep", word));
  }
  for (const std::string& text : divided_at(';', options.contact))
    if (const auto rule = rule_in(text))
      asked.of_parts.rules.push_back(*rule);
    else
      read_rules(text, asked.of_parts.rules);
  return asked;
}

}  // namespace octafront::intake
