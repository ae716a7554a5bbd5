#include "images/files/plist.h"

#include "formats/containers/scanner.h"

#include <array>
#include <utility>

#include <fmt/core.h>

namespace octafront::image {
namespace {

std::string unescaped(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, char>, 5> kNames{
      {{"&lt;", '<'}, {"&gt;", '>'}, {"&amp;", '&'}, {"&quot;", '"'}, {"&apos;", '\''}}};
  std::string out;
  while (!text.empty()) {
    std::size_t taken = 1;
    char c = text[0];
    for (const auto& [name, meant] : kNames)
      if (text.starts_with(name)) {
        taken = name.size();
        c = meant;
      }
    out += c;
    text.remove_prefix(taken);
  }
  return out;
}

class PlistParser {
 public:
  explicit PlistParser(const io::Input& input) : input_(input), rest_(input.bytes) {}

  Plist parse() {
    if (rest_.starts_with("bplist")) input_.fail("is a binary property list; XML is read here");
    std::string_view tag = next_tag();
    while (tag.starts_with('?') || tag.starts_with('!') || tag.starts_with("plist")) tag = next_tag();
    return value(tag, 0);
  }

 private:
  [[noreturn]] void fail(std::string_view message) const {
    input_.fail_at_line(rest_.data(), fmt::format("{}; the property list is damaged", message));
  }

  /// What stands between < and >; the text before it is passed over.
  std::string_view next_tag() {
    const std::size_t begin = rest_.find('<');
    const std::size_t end = rest_.find('>', begin);
    if (begin == std::string_view::npos || end == std::string_view::npos) fail("expected a tag");
    const std::string_view tag = rest_.substr(begin + 1, end - begin - 1);
    rest_.remove_prefix(end + 1);
    return tag;
  }

  /// The text up to </name>.
  std::string text_of(std::string_view name) {
    const std::string closing = fmt::format("</{}>", name);
    const std::size_t end = rest_.find(closing);
    if (end == std::string_view::npos) fail(fmt::format("expected {}", closing));
    std::string text = unescaped(rest_.substr(0, end));
    rest_.remove_prefix(end + closing.size());
    return text;
  }

  Plist value(std::string_view tag, int depth) {
    constexpr int kMostDepth = 64;
    if (depth > kMostDepth) fail("too many values inside one another");
    Plist out;
    if (tag.ends_with('/')) {
      out.text = tag.substr(0, tag.size() - 1);
      while (!out.text.empty() && io::is_blank(out.text.back())) out.text.pop_back();
    } else if (tag == "dict") {
      for (tag = next_tag(); tag != "/dict"; tag = next_tag()) {
        if (tag != "key") fail("expected a key");
        std::string key = text_of("key");
        out.dictionary[std::move(key)] = value(next_tag(), depth + 1);
      }
    } else if (tag == "array") {
      for (tag = next_tag(); tag != "/array"; tag = next_tag()) out.array.push_back(value(tag, depth + 1));
    } else if (tag.starts_with('/') || tag.empty()) {
      fail("expected a value");
    } else {
      out.text = text_of(tag);
    }
    return out;
  }

  const io::Input& input_;
  std::string_view rest_;
};

}  // namespace

const Plist& Plist::at(const std::string& key) const {
  static const Plist kEmpty;
  const auto found = dictionary.find(key);
  return found == dictionary.end() ? kEmpty : found->second;
}

Plist parse_plist(const io::Input& input) {
  return PlistParser(input).parse();
}

}  // namespace octafront::image
