// Names of files in UTF-8 on Windows. libstdc++ makes std::filesystem::path of std::string by this function of the C
// library, which knows the code pages of msvcrt.dll and not UTF-8; the linker puts ours in its place (--wrap=mbrtowc),
// in the whole program.

#include <cerrno>
#include <cstddef>
#include <cwchar>

namespace {

constexpr std::size_t kWrong = static_cast<std::size_t>(-1), kUnfinished = static_cast<std::size_t>(-2);

/// Bytes of the character that begins so; 0: none does.
std::size_t length_of(unsigned char first) {
  if (first < 0x80) return 1;
  if (first < 0xc2 || first > 0xf4) return 0;
  return first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
}

std::size_t wrong() {
  errno = EILSEQ;
  return kWrong;
}

}  // namespace

/// As mbrtowc(). A character beyond the first 65,536 is two of UTF-16: the first comes with three of its bytes, and
/// `state` keeps the second, which comes with the fourth.
extern "C" std::size_t __wrap_mbrtowc(wchar_t* to, const char* from, std::size_t size, std::mbstate_t* state) {
  if (from == nullptr) return 0;
  if (size == 0) return kUnfinished;
  if (state != nullptr && *state != 0) {
    if (to != nullptr) *to = static_cast<wchar_t>(*state);
    *state = 0;
    return 1;
  }
  const std::size_t length = length_of(static_cast<unsigned char>(*from));
  if (length == 0) return wrong();
  char32_t code = static_cast<unsigned char>(*from) & (length == 1 ? 0x7fU : 0xffU >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    if (i == size) return kUnfinished;
    const auto byte = static_cast<unsigned char>(from[i]);
    if ((byte & 0xc0) != 0x80) return wrong();
    code = code << 6 | (byte & 0x3f);
  }
  constexpr char32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
  if (code < kLeast[length] || code > 0x10ffff || (code >= 0xd800 && code < 0xe000)) return wrong();
  if (length == 4) {
    if (state == nullptr) return wrong();
    *state = static_cast<std::mbstate_t>(0xdc00 | (code & 0x3ff));
    code = 0xd7c0 + (code >> 10);
  }
  if (to != nullptr) *to = static_cast<wchar_t>(code);
  return code == 0 ? 0 : length == 4 ? 3 : length;
}
