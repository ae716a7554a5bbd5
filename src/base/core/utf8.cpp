#include "base/core/utf8.h"

#include "base/core/wording.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include <fmt/core.h>

namespace octafront {
namespace {

unsigned char byte_at(std::string_view text, std::size_t i) {
  return static_cast<unsigned char>(text[i]);
}

/// The length of the character at `i`, by the table of well-formed sequences of the Unicode standard (3-7); 0 where
/// there is none.
std::size_t length_at(std::string_view text, std::size_t i) {
  const unsigned char lead = byte_at(text, i);
  if (lead < 0x80) return 1;
  if (lead < 0xc2 || lead > 0xf4) return 0;
  const std::size_t length = lead < 0xe0 ? 2 : lead < 0xf0 ? 3 : 4;
  if (i + length > text.size()) return 0;
  // What would be overlong, a surrogate or too large shows in the second byte.
  const unsigned char lo = lead == 0xe0 ? 0xa0 : lead == 0xf0 ? 0x90 : 0x80;
  const unsigned char hi = lead == 0xed ? 0x9f : lead == 0xf4 ? 0x8f : 0xbf;
  if (byte_at(text, i + 1) < lo || byte_at(text, i + 1) > hi) return 0;
  for (std::size_t k = 2; k < length; ++k)
    if (byte_at(text, i + k) < 0x80 || byte_at(text, i + k) > 0xbf) return 0;
  return length;
}

/// Below U+10000.
void append_utf8(std::string& out, std::uint32_t c) {
  if (c < 0x80) {
    out += static_cast<char>(c);
  } else if (c < 0x800) {
    out += static_cast<char>(0xc0 | c >> 6);
    out += static_cast<char>(0x80 | (c & 0x3f));
  } else {
    out += static_cast<char>(0xe0 | c >> 12);
    out += static_cast<char>(0x80 | (c >> 6 & 0x3f));
    out += static_cast<char>(0x80 | (c & 0x3f));
  }
}

/// Windows-1252 from 0x80 to 0x9f; its five holes are control characters, which names lose.
constexpr std::array<std::uint16_t, 32> kWindows{0x20ac, 0x0081, 0x201a, 0x0192, 0x201e, 0x2026, 0x2020, 0x2021,
                                                 0x02c6, 0x2030, 0x0160, 0x2039, 0x0152, 0x008d, 0x017d, 0x008f,
                                                 0x0090, 0x2018, 0x2019, 0x201c, 0x201d, 0x2022, 0x2013, 0x2014,
                                                 0x02dc, 0x2122, 0x0161, 0x203a, 0x0153, 0x009d, 0x017e, 0x0178};

/// Control characters, U+FFFE and U+FFFF; `text` is UTF-8.
bool is_forbidden(std::string_view text, std::size_t i) {
  const unsigned char a = byte_at(text, i);
  if (a < 0x20 || a == 0x7f) return true;
  if (a == 0xc2) return byte_at(text, i + 1) < 0xa0;
  return a == 0xef && byte_at(text, i + 1) == 0xbf && byte_at(text, i + 2) >= 0xbe;
}

/// Blanks for what is forbidden. Returns whether there was any.
bool blank_forbidden(std::string& text) {
  std::string out;
  bool found = false;
  for (std::size_t i = 0, length = 0; i < text.size(); i += length) {
    length = length_at(text, i);
    const bool forbidden = is_forbidden(text, i);
    out += forbidden ? " " : text.substr(i, length);
    found = found || forbidden;
  }
  if (found) text = std::move(out);
  return found;
}

}  // namespace

bool is_utf8(std::string_view bytes) {
  for (std::size_t i = 0, length = 0; i < bytes.size(); i += length)
    if ((length = length_at(bytes, i)) == 0) return false;
  return true;
}

std::string utf8_of_latin1(std::string_view bytes) {
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const unsigned char c = byte_at(bytes, i);
    append_utf8(out, c >= 0x80 && c < 0xa0 ? kWindows[c - 0x80u] : c);
  }
  return out;
}

void NameCleaning::clean(std::string& name) {
  const bool is_latin1 = !is_utf8(name);
  if (is_latin1) name = utf8_of_latin1(name);
  const bool had_controls = blank_forbidden(name);
  if (is_latin1 && from_latin1_++ == 0) first_latin1_ = name;
  if (had_controls && with_controls_++ == 0) first_control_ = name;
}

void NameCleaning::clean(std::vector<std::string>& names) {
  for (std::string& name : names) clean(name);
}

std::string NameCleaning::note() const {
  const auto first = [](std::size_t n, const std::string& name) {
    return n == 1 ? fmt::format(": \"{}\"", name) : fmt::format("; the first is \"{}\"", name);
  };
  std::string all;
  if (from_latin1_ > 0)
    all = counted(from_latin1_, "name was", "names were") + " not in UTF-8 and taken as Latin-1" +
          first(from_latin1_, first_latin1_);
  if (with_controls_ > 0)
    all += (all.empty() ? "" : "; ") + counted(with_controls_, "name") +
           " had control characters, which became blanks" + first(with_controls_, first_control_);
  return all;
}

void NameCleaning::tell(std::vector<std::string>& notes) const {
  if (std::string said = note(); !said.empty()) notes.push_back(std::move(said));
}

}  // namespace octafront
