// The values of VTK's arrays: text, or binary (in base64 or raw), whole or in blocks compressed by zlib.

#include "io/scanner.h"
#include "io/vtk_xml.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include <fmt/format.h>
#include <zlib.h>

namespace octafront::io {
namespace {

static_assert(std::endian::native == std::endian::little, "binary values are copied as they are");

/// Bytes of a file, decoded from base64 on the way if need be.
class ByteSource {
 public:
  ByteSource(std::string_view text, bool is_base64) : text_(text), is_base64_(is_base64) {}

  std::size_t most_bytes_left() const { return is_base64_ ? text_.size() / 4 * 3 : text_.size(); }

  /// The next bytes; in base64 they must be a unit of their own (padded to whole groups of four characters).
  bool take(std::size_t count, std::vector<char>& bytes) {
    bytes.clear();
    if (count > most_bytes_left()) return false;
    if (!is_base64_) {
      bytes.assign(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(count));
      text_.remove_prefix(count);
      return true;
    }
    bytes.reserve(count + 2);
    while (bytes.size() < count)
      if (!take_group(bytes)) return false;
    bytes.resize(count);
    return true;
  }

 private:
  static int digit(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' ? 62 : c == '/' ? 63 : c == '=' ? 0 : -1;
  }

  bool take_group(std::vector<char>& bytes) {
    if (text_.size() < 4) return false;
    unsigned bits = 0;
    for (int k = 0; k < 4; ++k) {
      const int d = digit(text_[static_cast<std::size_t>(k)]);
      if (d < 0) return false;
      bits = bits << 6 | static_cast<unsigned>(d);
    }
    for (const int shift : {16, 8, 0}) bytes.push_back(static_cast<char>(bits >> shift & 0xff));
    text_.remove_prefix(4);
    return true;
  }

  std::string_view text_;
  bool is_base64_;
};

class ArrayReader {
 public:
  ArrayReader(const VtkXml& xml, const VtkArray& array, const Input& input) : xml_(xml), array_(array), input_(input) {}

  std::vector<char> bytes() {
    ByteSource source = open();
    return xml_.is_compressed ? unpacked(source) : plain(source);
  }

  [[noreturn]] void fail(std::string_view message) const {
    input_.fail_at_line(array_.at,
                        fmt::format("array {}: {}; the file is damaged or truncated: copy or export it again",
                                    in_quotes(array_.name), message));
  }

 private:
  ByteSource open() {
    if (array_.format == "appended") {
      if (array_.offset > xml_.appended.size())
        fail(fmt::format("begins at byte {} of the appended data, which have {}", array_.offset, xml_.appended.size()));
      return {xml_.appended.substr(array_.offset), xml_.appended_is_base64};
    }
    if (array_.format != "binary") fail(fmt::format("has the unknown format {}", in_quotes(array_.format)));
    std::string_view text = array_.text;
    while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
    return {text, true};
  }

  std::size_t header_bytes() const { return xml_.long_headers ? 8 : 4; }

  std::uint64_t header_value(const std::vector<char>& bytes, std::size_t i) const {
    std::uint64_t value = 0;  // little endian: the low bytes come first
    std::memcpy(&value, bytes.data() + i * header_bytes(), header_bytes());
    return value;
  }

  /// The length and the values form one unit of base64.
  std::vector<char> plain(ByteSource& source) {
    ByteSource copy = source;
    std::vector<char> bytes;
    if (!copy.take(header_bytes(), bytes)) fail("its length is missing");
    const std::uint64_t size = header_value(bytes, 0);
    if (size > source.most_bytes_left() || !source.take(header_bytes() + size, bytes))
      fail(fmt::format("claims {} bytes, more than the file has", size));
    bytes.erase(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(header_bytes()));
    return bytes;
  }

  /// Number of blocks, size of a block, size of the last one if smaller, compressed sizes; then, a unit of base64 of
  /// their own, the compressed blocks.
  std::vector<char> unpacked(ByteSource& source) {
    std::vector<char> header;
    ByteSource copy = source;
    if (!copy.take(header_bytes(), header)) fail("its number of blocks is missing");
    const std::uint64_t blocks = header_value(header, 0);
    if (blocks > source.most_bytes_left() / header_bytes() || !source.take((3 + blocks) * header_bytes(), header))
      fail(fmt::format("claims {} blocks, more than the file has", blocks));
    const std::uint64_t block_size = header_value(header, 1), last_size = header_value(header, 2);
    std::uint64_t packed_size = 0;
    for (std::uint64_t b = 0; b < blocks; ++b) {
      const std::uint64_t size = header_value(header, 3 + b);
      if (size > source.most_bytes_left() || (packed_size += size) > source.most_bytes_left())
        fail(fmt::format("claims {} bytes for block {}, more than the file has", size, b));
    }
    std::vector<char> packed, bytes;
    if (!source.take(packed_size, packed)) fail("its blocks are missing");
    std::uint64_t at = 0;
    for (std::uint64_t b = 0; b < blocks; ++b) {
      const std::uint64_t size = header_value(header, 3 + b);
      append_block({packed.data() + at, size}, b + 1 == blocks && last_size != 0 ? last_size : block_size, b, bytes);
      at += size;
    }
    return bytes;
  }

  void append_block(std::string_view packed, std::uint64_t size, std::uint64_t block, std::vector<char>& bytes) {
    constexpr std::uint64_t kBestRatio = 1032;  // of deflate
    if (size > kBestRatio * (packed.size() + 1)) fail(fmt::format("claims {} bytes for block {}", size, block));
    const std::size_t begin = bytes.size();
    bytes.resize(begin + size);
    uLongf done = size;
    if (uncompress(reinterpret_cast<Bytef*>(bytes.data() + begin), &done, reinterpret_cast<const Bytef*>(packed.data()),
                   packed.size()) != Z_OK ||
        done != size)
      fail(fmt::format("block {} cannot be decompressed", block));
  }

  const VtkXml& xml_;
  const VtkArray& array_;
  const Input& input_;
};

template <class T, class Value>
std::vector<Value> converted(const std::vector<char>& bytes) {
  std::vector<Value> values(bytes.size() / sizeof(T));
  for (std::size_t i = 0; i < values.size(); ++i) {
    T value;
    std::memcpy(&value, bytes.data() + i * sizeof(T), sizeof(T));
    values[i] = static_cast<Value>(value);
  }
  return values;
}

template <class Value>
std::vector<Value> text_values(const VtkArray& array, const Input& input) {
  // A scanner of its own that ends where the tag does, but reports places of the whole file.
  Input part = input;
  part.bytes =
      input.bytes.substr(0, static_cast<std::size_t>(array.text.data() + array.text.size() - input.bytes.data()));
  std::vector<Value> values;
  if (array.text.empty()) return values;
  Scanner scan(part);
  scan.set_position(array.text.data());
  while (!scan.at_end()) {
    if constexpr (std::is_same_v<Value, double>) {
      values.push_back(scan.number("a number"));
    } else {
      values.push_back(scan.integer("a whole number"));
    }
  }
  return values;
}

}  // namespace

std::vector<double> vtk_reals(const VtkXml& xml, const VtkArray& array, const Input& input) {
  if (array.format == "ascii") return text_values<double>(array, input);
  ArrayReader reader(xml, array, input);
  if (array.type == "Float64") return converted<double, double>(reader.bytes());
  if (array.type == "Float32") return converted<float, double>(reader.bytes());
  reader.fail(fmt::format("has the type {}; expected Float64 or Float32", in_quotes(array.type)));
}

std::vector<std::int64_t> vtk_integers(const VtkXml& xml, const VtkArray& array, const Input& input) {
  if (array.format == "ascii") return text_values<std::int64_t>(array, input);
  ArrayReader reader(xml, array, input);
  if (array.type == "Int8") return converted<std::int8_t, std::int64_t>(reader.bytes());
  if (array.type == "UInt8") return converted<std::uint8_t, std::int64_t>(reader.bytes());
  if (array.type == "Int16") return converted<std::int16_t, std::int64_t>(reader.bytes());
  if (array.type == "UInt16") return converted<std::uint16_t, std::int64_t>(reader.bytes());
  if (array.type == "Int32") return converted<std::int32_t, std::int64_t>(reader.bytes());
  if (array.type == "UInt32") return converted<std::uint32_t, std::int64_t>(reader.bytes());
  if (array.type == "Int64" || array.type == "UInt64") return converted<std::int64_t, std::int64_t>(reader.bytes());
  reader.fail(fmt::format("has the type {}; expected integers", in_quotes(array.type)));
}

}  // namespace octafront::io
