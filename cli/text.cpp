#include "text.h"

#include <algorithm>
#include <cstdint>
#include <numeric>

#include <fmt/core.h>

namespace octafront::cli {

namespace {

/// Bytes of the UTF-8 character that begins `text`; 0 if none does.
std::size_t character_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const std::size_t length = byte(0) < 0x80 ? 1 : byte(0) < 0xc2 ? 0 : byte(0) < 0xe0 ? 2 : byte(0) < 0xf0 ? 3 : 4;
  if (length == 0 || length > text.size() || byte(0) > 0xf4) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if (byte(i) >> 6 != 2) return 0;
  return length;
}

/// The code point of a character of one to three bytes; else 0x10000.
std::uint32_t code_point(std::string_view character) {
  const auto byte = [&](std::size_t i) { return std::uint32_t{static_cast<unsigned char>(character[i])}; };
  if (character.size() == 1) return byte(0);
  if (character.size() == 2) return (byte(0) & 0x1f) << 6 | (byte(1) & 0x3f);
  if (character.size() == 3) return (byte(0) & 0xf) << 12 | (byte(1) & 0x3f) << 6 | (byte(2) & 0x3f);
  return 0x10000;
}

/// What moves the cursor, or what is written around it: also lines, paragraphs and directions of Unicode.
bool is_control(std::string_view character) {
  const std::uint32_t c = code_point(character);
  return (c < 0x20 && c != '\n') || (c >= 0x7f && c < 0xa0) || (c >= 0x2028 && c <= 0x202e) ||
         (c >= 0x2066 && c <= 0x2069) || c == 0x200e || c == 0x200f || c == 0xfeff;
}

void replace_all(std::string& text, const std::string& word, const std::string& by) {
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + by.size()))
    text.replace(at, word.size(), by);
}

/// Insertions, deletions and replacements of a character between two words.
std::size_t edits_between(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string printable(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    const std::string_view character = text.substr(0, std::max<std::size_t>(1, length));
    if (length > 0 && !is_control(character)) {
      out += character;
    } else {
      for (const char c : character) out += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    }
    text.remove_prefix(character.size());
  }
  return out;
}

std::string printable(std::string text, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    std::string flat = word;
    replace_all(flat, "\n", "\\n");
    replace_all(text, word, flat);
  }
  return printable(text);
}

std::vector<std::string> words_with_line_ends(int argc, const char* const* argv) {
  std::vector<std::string> words;
  const auto add = [&](const std::string& word) {
    if (word.find('\n') != std::string::npos && word != "\n") words.push_back(word);
  };
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word.find('\n') == std::string::npos) continue;
    const std::filesystem::path value = word.substr(word.find('=') + 1);
    for (const std::filesystem::path& part : {std::filesystem::path(word), value, value.filename(), value.stem()})
      add(part.string());
  }
  std::stable_sort(words.begin(), words.end(), [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return words;
}

std::string printable_json(const std::string& text) {
  std::string out;
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t length = std::max<std::size_t>(1, character_length(rest));
    const std::string_view character = rest.substr(0, length);
    out += is_control(character) ? fmt::format("\\u{:04x}", code_point(character)) : std::string(character);
    rest.remove_prefix(length);
  }
  return out;
}

std::string quoted_for_shell(const std::string& text) {
  constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_@%+=:,./-";
  if (!text.empty() && text.find_first_not_of(kPlain) == std::string::npos) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string nearest_word(std::string_view typed, const std::vector<std::string>& words) {
  std::string nearest;
  std::size_t least = 2 + typed.size() / 4;
  for (const std::string& word : words) {
    const std::size_t edits = edits_between(typed, word);
    if (edits >= std::min(least, word.size())) continue;
    least = edits;
    nearest = word;
  }
  return nearest;
}

std::string counted(std::size_t n, const std::string& one) {
  return fmt::format("{} {}{}", n, one, n == 1 ? "" : "s");
}

std::vector<std::string> in_utf8(const std::vector<std::filesystem::path>& files) {
  std::vector<std::string> names;
  for (const std::filesystem::path& file : files) names.push_back(file.string());
  return names;
}

}  // namespace octafront::cli
