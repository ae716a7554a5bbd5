// The values of VTK's arrays: text, or binary (in base64 or raw), whole or in blocks compressed by zlib.

#include "formats/containers/scanner.h"
#include "formats/containers/vtk_xml.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include <fmt/core.h>
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

/// No array of a mesh has more; the bytes of so many can still be counted.
constexpr std::uint64_t kMostValues = std::uint64_t{1} << 60;

class ArrayReader {
 public:
  /// `most_bytes`: what the counts of the file allow the values to take.
  ArrayReader(const VtkXml& xml, const VtkArray& array, const Input& input, std::uint64_t most_bytes)
      : xml_(xml), array_(array), input_(input), most_bytes_(most_bytes) {}

  std::vector<char> bytes() {
    ByteSource source = open();
    return xml_.is_compressed ? unpacked(source) : plain(source);
  }

  [[noreturn]] void fail(std::string_view message) const {
    input_.fail_at_line(array_.at, fmt::format("{}: {}; the file is damaged or truncated: copy or export it again",
                                               array_.label(), message));
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
    check_block_sizes(header, blocks, source.most_bytes_left());
    std::uint64_t packed_size = 0;
    for (std::uint64_t b = 0; b < blocks; ++b) packed_size += header_value(header, 3 + b);
    std::vector<char> packed, bytes;
    if (!source.take(packed_size, packed)) fail("its blocks are missing");
    std::uint64_t at = 0;
    for (std::uint64_t b = 0; b < blocks; ++b) {
      input_.context.check();
      const std::uint64_t size = header_value(header, 3 + b);
      append_block({packed.data() + at, static_cast<std::size_t>(size)}, block_size(header, b), b, bytes);
      at += size;
    }
    return bytes;
  }

  /// Of block b, unpacked.
  std::uint64_t block_size(const std::vector<char>& header, std::uint64_t b) const {
    const std::uint64_t blocks = header_value(header, 0), last = header_value(header, 2);
    return b + 1 == blocks && last != 0 ? last : header_value(header, 1);
  }

  /// A few kilobytes can unpack to gigabytes: nothing is unpacked that could not belong to the mesh.
  void check_block_sizes(const std::vector<char>& header, std::uint64_t blocks, std::uint64_t packed_left) const {
    std::uint64_t left = most_bytes_;
    for (std::uint64_t b = 0; b < blocks; ++b) {
      const std::uint64_t packed = header_value(header, 3 + b), unpacked = block_size(header, b);
      if (packed > packed_left) fail(fmt::format("claims {} bytes for block {}, more than the file has", packed, b));
      if (unpacked > left)
        fail(fmt::format("its blocks hold more than the {} bytes that its values take at most", most_bytes_));
      packed_left -= packed;
      left -= unpacked;
    }
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
  std::uint64_t most_bytes_;
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

namespace {

template <class Value>
using Conversion = std::vector<Value> (*)(const std::vector<char>&);

/// Bytes of one value as it is stored, and how bytes become values.
template <class Value>
struct StoredType {
  std::string_view name;
  std::uint64_t bytes;
  Conversion<Value> convert;
};

template <class T, class Value>
constexpr StoredType<Value> stored(std::string_view name) {
  return {name, sizeof(T), converted<T, Value>};
}

constexpr std::array kRealTypes{stored<double, double>("Float64"), stored<float, double>("Float32")};
using Whole = std::int64_t;
constexpr std::array kWholeTypes{stored<std::int8_t, Whole>("Int8"),   stored<std::uint8_t, Whole>("UInt8"),
                                 stored<std::int16_t, Whole>("Int16"), stored<std::uint16_t, Whole>("UInt16"),
                                 stored<std::int32_t, Whole>("Int32"), stored<std::uint32_t, Whole>("UInt32"),
                                 stored<std::int64_t, Whole>("Int64"), stored<std::int64_t, Whole>("UInt64")};

template <class Value, std::size_t N>
std::vector<Value> values(const VtkXml& xml, const VtkArray& array, const Input& input, std::uint64_t most_values,
                          const std::array<StoredType<Value>, N>& types, std::string_view expected) {
  if (array.format == "ascii") return text_values<Value>(array, input);
  for (const StoredType<Value>& type : types)
    if (array.type == type.name)
      return type.convert(ArrayReader(xml, array, input, type.bytes * std::min(most_values, kMostValues)).bytes());
  input.fail_at_line(array.at,
                     fmt::format("{} has the type {}; expected {}", array.label(), in_quotes(array.type), expected));
}

}  // namespace

std::vector<double> vtk_reals(const VtkXml& xml, const VtkArray& array, const Input& input, std::uint64_t most_values) {
  return values(xml, array, input, most_values, kRealTypes, "Float64 or Float32");
}

std::vector<std::int64_t> vtk_integers(const VtkXml& xml, const VtkArray& array, const Input& input,
                                       std::uint64_t most_values) {
  return values(xml, array, input, most_values, kWholeTypes, "integers");
}

}  // namespace octafront::io
