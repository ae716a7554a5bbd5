#include <octafront/picture.h>

#include <array>
#include <cstdlib>
#include <new>

#include <zlib.h>

namespace octafront {

namespace {

constexpr std::size_t kBytesOfPixel = 3;

void add_big_endian(std::string& to, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) to += static_cast<char>(value >> shift & 0xff);
}

/// Length, name, data, and the check of name and data.
void add_chunk(std::string& png, const std::string& name, const std::string& data) {
  add_big_endian(png, static_cast<std::uint32_t>(data.size()));
  const std::string checked = name + data;
  png += checked;
  add_big_endian(png, static_cast<std::uint32_t>(
                          crc32(0, reinterpret_cast<const Bytef*>(checked.data()), static_cast<uInt>(checked.size()))));
}

/// A row as differences: 0 none, 1 to the pixel before, 2 to the row above. `above` may be null.
std::string filtered(const std::uint8_t* row, const std::uint8_t* above, std::size_t bytes, int filter) {
  std::string made(1, static_cast<char>(filter));
  for (std::size_t i = 0; i < bytes; ++i) {
    const int before = filter == 1 && i >= kBytesOfPixel ? row[i - kBytesOfPixel] : 0;
    const int up = filter == 2 && above != nullptr ? above[i] : 0;
    made += static_cast<char>((row[i] - before - up) & 0xff);
  }
  return made;
}

/// The sum of differences, by which encoders guess what will be small.
std::uint64_t weight(const std::string& row) {
  std::uint64_t sum = 0;
  for (std::size_t i = 1; i < row.size(); ++i)
    sum += static_cast<std::uint64_t>(std::abs(static_cast<int>(static_cast<signed char>(row[i]))));
  return sum;
}

std::string filtered_rows(const Picture& picture) {
  const std::size_t bytes = kBytesOfPixel * static_cast<std::size_t>(picture.width);
  std::string all;
  for (std::size_t y = 0; y < static_cast<std::size_t>(picture.height); ++y) {
    const std::uint8_t* row = &picture.pixels[bytes * y];
    std::string best = filtered(row, nullptr, bytes, 0);
    for (const int filter : {1, 2}) {
      std::string other = filtered(row, y == 0 ? nullptr : row - bytes, bytes, filter);
      if (weight(other) < weight(best)) best = std::move(other);
    }
    all += best;
  }
  return all;
}

std::string deflated(const std::string& text) {
  uLongf size = compressBound(static_cast<uLong>(text.size()));
  std::string out(size, '\0');
  constexpr int kLevel = 6;
  if (compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(text.data()),
                static_cast<uLong>(text.size()), kLevel) != Z_OK)
    throw std::bad_alloc();
  out.resize(size);
  return out;
}

}  // namespace

// W3C, Portable Network Graphics (PNG) Specification: signature, header, one stream of data, end.
std::string to_png(const Picture& picture) {
  std::string png = "\x89PNG\r\n\x1a\n", header;
  add_big_endian(header, static_cast<std::uint32_t>(picture.width));
  add_big_endian(header, static_cast<std::uint32_t>(picture.height));
  header.append({8, 2, 0, 0, 0});  // bits a channel, red-green-blue, and the only ways there are
  add_chunk(png, "IHDR", header);
  add_chunk(png, "IDAT", deflated(filtered_rows(picture)));
  add_chunk(png, "IEND", {});
  return png;
}

std::string to_base64(std::string_view bytes) {
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

}  // namespace octafront
