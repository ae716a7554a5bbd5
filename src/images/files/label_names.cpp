// Names of values, in the ways that people keep them.

#include "images/files/label_names.h"

#include <octafront/image.h>

#include "base/core/utf8.h"
#include "formats/containers/scanner.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include <fmt/core.h>

namespace octafront {

namespace {

using Json = nlohmann::ordered_json;

bool is_whole_number(std::string_view word, std::int64_t& value) {
  double number = 0;
  if (!io::parse_number(word, number) || number != std::floor(number) || !(std::abs(number) < 1e15)) return false;
  value = static_cast<std::int64_t>(number);
  return true;
}

/// Names that come in, each value once.
class Names {
 public:
  explicit Names(const io::Input& input) : input_(input) {}

  void add(std::int64_t value, std::string name, const char* at) {
    if (name.empty()) input_.fail_at_line(at, fmt::format("the value {} has an empty name", value));
    const auto [found, is_new] = names_.emplace(value, std::move(name));
    if (!is_new)
      input_.fail_at_line(at, fmt::format("the value {} has a name already, {}", value, io::in_quotes(found->second)));
  }

  std::vector<LabelName> all() const {
    if (names_.empty())
      input_.fail("holds no names of labels: expected lines such as \"3 liver\", or JSON such as {\"3\": \"liver\"}");
    std::vector<LabelName> list;
    for (const auto& [value, name] : names_) list.push_back({value, name});
    return list;
  }

 private:
  const io::Input& input_;
  std::map<std::int64_t, std::string> names_;
};

/// A line of a table in its words; those in quotes lose them.
struct Line {
  std::vector<std::string> words;
  std::vector<bool> quoted;
  const char* at = nullptr;
};

/// Divides at commas, semicolons or tabs where there are any, else at blanks; quotes keep words together.
Line divided(std::string_view text, const char* at) {
  Line line;
  line.at = at;
  const std::string_view separators = text.find('\t') != std::string_view::npos  ? "\t"
                                      : text.find(',') != std::string_view::npos ? ","
                                      : text.find(';') != std::string_view::npos ? ";"
                                                                                 : " ";
  std::string word;
  bool in_quotes = false, was_quoted = false;
  const auto finish = [&] {
    while (!was_quoted && !word.empty() && io::is_blank(word.back())) word.pop_back();
    if (separators != " " || !word.empty() || was_quoted) {
      line.words.push_back(word);
      line.quoted.push_back(was_quoted);
    }
    word.clear();
    was_quoted = false;
  };
  for (const char c : text) {
    if (c == '"') {
      in_quotes = !in_quotes;
      was_quoted = true;
    } else if (!in_quotes && (c == separators[0] || (separators == " " && io::is_blank(c)))) {
      finish();
    } else if (in_quotes || !word.empty() || !io::is_blank(c)) {
      word += c;
    }
  }
  finish();
  return line;
}

class Table {
 public:
  explicit Table(const io::Input& input) : input_(input), names_(input) {}

  std::vector<LabelName> read() {
    divide();
    if (!lines_.empty() && has_titles()) {
      read_by_titles();
    } else {
      read_by_place();
    }
    return names_.all();
  }

 private:
  void divide() {
    const std::string_view bytes = input_.bytes;
    std::size_t begin = bytes.starts_with("\xef\xbb\xbf") ? 3 : 0;
    while (begin < bytes.size()) {
      const std::size_t end = std::min(bytes.find_first_of("\r\n", begin), bytes.size());
      std::string_view text = bytes.substr(begin, end - begin);
      while (!text.empty() && io::is_blank(text.front())) text.remove_prefix(1);
      while (!text.empty() && io::is_blank(text.back())) text.remove_suffix(1);
      if (!text.empty() && text[0] != '#' && !text.starts_with("//"))
        lines_.push_back(divided(text, bytes.data() + begin));
      begin = end + 1;
    }
  }

  static std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), io::to_lower);
    return text;
  }

  static std::size_t column(const Line& titles, std::initializer_list<const char*> known) {
    for (const char* name : known)
      for (std::size_t i = 0; i < titles.words.size(); ++i)
        if (lower(titles.words[i]) == name) return i;
    return titles.words.size();
  }

  bool has_titles() {
    std::int64_t value = 0;
    if (is_whole_number(lines_[0].words[0], value)) return false;
    const Line& titles = lines_[0];
    value_column_ = column(titles, {"value", "labelvalue", "index", "id", "number", "label"});
    name_column_ = column(titles, {"name", "labelname", "label name", "structure", "region"});
    if (name_column_ == titles.words.size()) name_column_ = column(titles, {"label"});
    return value_column_ < titles.words.size() && name_column_ < titles.words.size() && value_column_ != name_column_;
  }

  void read_by_titles() {
    for (std::size_t i = 1; i < lines_.size(); ++i) {
      const Line& line = lines_[i];
      std::int64_t value = 0;
      if (line.words.size() <= std::max(value_column_, name_column_) ||
          !is_whole_number(line.words[value_column_], value))
        fail(line);
      names_.add(value, line.words[name_column_], line.at);
    }
  }

  // The first word is the value. A quoted word is the name; else what is left without the numbers at the end, if all
  // lines have equally many of them: "Area 17" keeps its number in a list of names alone.
  void read_by_place() {
    const std::size_t behind = numbers_behind_names();
    for (const Line& line : lines_) {
      std::int64_t value = 0;
      if (line.words.size() < 2 || !is_whole_number(line.words[0], value)) fail(line);
      const auto quoted = std::find(line.quoted.begin() + 1, line.quoted.end(), true);
      if (quoted != line.quoted.end()) {
        names_.add(value, line.words[static_cast<std::size_t>(quoted - line.quoted.begin())], line.at);
        continue;
      }
      std::string name;
      for (std::size_t i = 1; i + behind < line.words.size(); ++i) name += (i > 1 ? " " : "") + line.words[i];
      names_.add(value, name, line.at);
    }
  }

  std::size_t numbers_behind_names() const {
    std::size_t least = lines_.empty() ? 0 : lines_[0].words.size(), most = 0;
    for (const Line& line : lines_) {
      std::size_t n = 0;
      double value = 0;
      while (n + 2 < line.words.size() && io::parse_number(line.words[line.words.size() - 1 - n], value)) ++n;
      least = std::min(least, n);
      most = std::max(most, n);
    }
    return least == most ? least : 0;
  }

  [[noreturn]] void fail(const Line& line) const {
    input_.fail_at_line(line.at, "expected a whole number and a name, such as \"3 liver\"");
  }

  const io::Input& input_;
  Names names_;
  std::vector<Line> lines_;
  std::size_t value_column_ = 0, name_column_ = 0;
};

class JsonNames {
 public:
  explicit JsonNames(const io::Input& input) : input_(input), names_(input) {}

  std::vector<LabelName> read() {
    Json all;
    try {
      all = Json::parse(input_.bytes);
    } catch (const Json::parse_error& e) {
      input_.fail_at_byte(input_.bytes.data() + std::min(e.byte, input_.bytes.size()),
                          is_utf8(input_.bytes) ? "is no valid JSON here"
                                                : "is no valid JSON here: JSON is in UTF-8, and this is not; save "
                                                  "it as UTF-8");
    }
    const Json& list = all.is_object() && all.contains("labels") ? all["labels"] : all;
    if (list.is_array()) {
      for (const Json& entry : list) add_entry(entry);
    } else if (list.is_object()) {
      for (const auto& [key, value] : list.items()) add_pair(key, value);
    }
    return names_.all();
  }

 private:
  void add(std::int64_t value, std::string name) { names_.add(value, std::move(name), input_.bytes.data()); }

  /// {"3": "liver"} or {"liver": 3}
  void add_pair(const std::string& key, const Json& value) {
    std::int64_t number = 0;
    if (value.is_string() && is_whole_number(key, number)) return add(number, value.get<std::string>());
    if (value.is_number_integer()) return add(value.get<std::int64_t>(), key);
    if (value.is_object() && is_whole_number(key, number) && value.contains("name") && value["name"].is_string())
      return add(number, value["name"].get<std::string>());
    input_.fail(fmt::format("the entry {} is neither \"3\": \"liver\" nor \"liver\": 3", io::in_quotes(key)));
  }

  /// {"value": 3, "name": "liver"}
  void add_entry(const Json& entry) {
    if (entry.is_object() && entry.contains("name") && entry["name"].is_string())
      for (const char* key : {"value", "labelValue", "label", "index", "id"})
        if (entry.contains(key) && entry[key].is_number_integer())
          return add(entry[key].get<std::int64_t>(), entry["name"].get<std::string>());
    input_.fail("has an entry that is not like {\"value\": 3, \"name\": \"liver\"}");
  }

  const io::Input& input_;
  Names names_;
};

}  // namespace

namespace image {

std::vector<LabelName> read_label_names_bytes(const io::Input& input) {
  const std::size_t first = input.bytes.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  const bool is_json = first != std::string_view::npos && (input.bytes[first] == '{' || input.bytes[first] == '[');
  return is_json ? JsonNames(input).read() : Table(input).read();
}

}  // namespace image

std::vector<LabelName> read_label_names(const std::string& file, const RunContext& context) {
  return image::read_label_names_bytes(io::LoadedFile(file, context).input());
}

}  // namespace octafront
