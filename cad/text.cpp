#include "text.h"

#include <algorithm>
#include <cctype>

namespace octafront::cad {

namespace {

/// How many bytes the character takes that begins with this one; 0: none begins so.
std::size_t bytes_of_character(unsigned char lead) {
  if (lead < 0x80) return 1;
  if (lead >= 0xc2 && lead < 0xe0) return 2;
  if (lead >= 0xe0 && lead < 0xf0) return 3;
  if (lead >= 0xf0 && lead < 0xf5) return 4;
  return 0;
}

}  // namespace

bool is_utf8(std::string_view bytes) {
  for (std::size_t i = 0; i < bytes.size();) {
    const std::size_t n = bytes_of_character(static_cast<unsigned char>(bytes[i]));
    if (n == 0 || i + n > bytes.size()) return false;
    for (std::size_t k = 1; k < n; ++k)
      if ((static_cast<unsigned char>(bytes[i + k]) & 0xc0) != 0x80) return false;
    i += n;
  }
  return true;
}

std::string to_utf8(std::string_view bytes) {
  const bool already = is_utf8(bytes);
  std::string text;
  for (const char c : bytes) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x20 || code == 0x7f) continue;
    if (already || code < 0x80) {
      text += c;
    } else {
      text += static_cast<char>(0xc0 | (code >> 6));
      text += static_cast<char>(0x80 | (code & 0x3f));
    }
  }
  const auto blank = [](char c) { return c == ' '; };
  text.erase(std::find_if_not(text.rbegin(), text.rend(), blank).base(), text.end());
  text.erase(text.begin(), std::find_if_not(text.begin(), text.end(), blank));
  return text;
}

bool says_nothing(std::string_view name) {
  std::string lower(name);
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
  for (const char* empty : {"", "none", "none.", "noname", "unnamed", "$", "''", "solid", "shell", "face", "compound"})
    if (lower == empty) return true;
  return lower.starts_with("open cascade step translator");
}

}  // namespace octafront::cad
