#include "report/page/bytes.h"

#include <new>

#include <zlib.h>

namespace octafront {

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto at = [&](std::size_t k) {
      return i + k < bytes.size() ? std::uint32_t{static_cast<unsigned char>(bytes[i + k])} : 0;
    };
    const std::uint32_t three = at(0) << 16 | at(1) << 8 | at(2);
    for (int shift = 18; shift >= 0; shift -= 6) text += kDigits[three >> shift & 63];
  }
  for (std::size_t left = bytes.size() % 3; left != 0 && left < 3; ++left) text[text.size() + left - 3] = '=';
  return text;
}

std::string packed(const Bytes& bytes) {
  uLongf size = compressBound(bytes.all().size());
  std::string out(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(out.data()), &size, bytes.all().data(), bytes.all().size(), 6) != Z_OK)
    throw std::bad_alloc();
  out.resize(size);
  return base64(out);
}

}  // namespace octafront
