// An array of numpy, .npy, of three dimensions (i, j, k), in the order of C or of Fortran.
// https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html

#include "formats/containers/scanner.h"
#include "images/files/byte_source.h"
#include "images/files/image_readers.h"
#include "images/files/voxels.h"

#include <map>
#include <optional>

#include <fmt/core.h>

namespace octafront::image {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kMagic = "\x93NUMPY"sv;

std::optional<VoxelType> type_of_numpy(std::string_view code) {
  static const std::map<std::string_view, VoxelType> kCodes{
      {"b1", VoxelType::kUInt8},  {"i1", VoxelType::kInt8},    {"u1", VoxelType::kUInt8},  {"i2", VoxelType::kInt16},
      {"u2", VoxelType::kUInt16}, {"i4", VoxelType::kInt32},   {"u4", VoxelType::kUInt32}, {"i8", VoxelType::kInt64},
      {"u8", VoxelType::kUInt64}, {"f4", VoxelType::kFloat32}, {"f8", VoxelType::kFloat64}};
  const auto found = kCodes.find(code);
  return found == kCodes.end() ? std::nullopt : std::optional(found->second);
}

/// The header is a dictionary of Python: {'descr': '<i2', 'fortran_order': False, 'shape': (5, 4, 3), }.
class Npy {
 public:
  explicit Npy(const Reading& reading) : input_(reading.input), source_(input_, 0, Packing::kDetect) {}

  Image read() {
    read_header();
    const StoredVoxels stored = stored_as();
    image_.format = "array of numpy";
    image_.notes.emplace_back("an array has no spacing: 1 is taken, from 0 on");
    image_.grid.size = checked_sizes(input_, shape());
    image_.values = read_voxels(source_, image_.grid.size, stored, image_.notes);
    if (behind("'fortran_order'").starts_with("False"))
      std::visit([this](auto& values) { values = in_fortran_order(values); }, image_.values);
    return std::move(image_);
  }

 private:
  void read_header() {
    const std::string begin(source_.require(kMagic.size() + 4, "the header"));
    const auto byte = [](std::string_view bytes, std::size_t i) {
      return std::size_t{static_cast<unsigned char>(bytes[i])};
    };
    std::size_t length = byte(begin, 8) | byte(begin, 9) << 8;
    if (begin[6] != 1) {
      const std::string more(source_.require(2, "the header"));
      length |= byte(more, 0) << 16 | byte(more, 1) << 24;
    }
    constexpr std::size_t kMost = 1 << 16;
    if (length > kMost) input_.fail(fmt::format("claims a header of {} bytes; the file is damaged", length));
    header_ = source_.require(length, "the header");
  }

  /// What stands behind a key and its colon.
  std::string_view behind(std::string_view key) const {
    const std::size_t at = header_.find(key);
    const std::size_t colon = header_.find(':', at == std::string::npos ? at : at + key.size());
    if (colon == std::string::npos) input_.fail(fmt::format("has no {} in its header; the file is damaged", key));
    return io::trimmed(std::string_view(header_).substr(colon + 1));
  }

  StoredVoxels stored_as() const {
    const std::string_view text = behind("'descr'"), code = text.substr(0, text.find('\'', 1));
    const auto type = code.size() == 4 ? type_of_numpy(code.substr(2)) : std::nullopt;
    if (!type) input_.fail(fmt::format("holds {}, not numbers that are read here", io::in_quotes(text.substr(0, 20))));
    StoredVoxels stored;
    stored.type = *type;
    stored.big_endian = code[1] == '>';
    return stored;
  }

  Sizes shape() const {
    std::string_view text = behind("'shape'");
    text = text.substr(0, text.find(')'));
    std::vector<double> sizes;
    for (std::size_t at = 1; at < text.size();) {
      const std::size_t end = std::min(text.find(',', at), text.size());
      double value = 0;
      if (const std::string_view word = io::trimmed(text.substr(at, end - at)); !word.empty()) {
        if (!io::parse_number(word, value) || !(value >= 0 && value < 1e15))
          input_.fail("has no shape that is read here");
        sizes.push_back(value);
      }
      at = end + 1;
    }
    if (sizes.size() != 3) input_.fail(fmt::format("has {} dimensions; three are read here, i, j, k", sizes.size()));
    return {static_cast<std::int64_t>(sizes[0]), static_cast<std::int64_t>(sizes[1]),
            static_cast<std::int64_t>(sizes[2])};
  }

  template <class T>
  std::vector<T> in_fortran_order(const std::vector<T>& values) const {
    const auto [ni, nj, nk] = image_.grid.size;
    std::vector<T> turned(values.size());
    std::size_t at = 0;
    for (std::size_t i = 0; i < ni; ++i)
      for (std::size_t j = 0; j < nj; ++j)
        for (std::size_t k = 0; k < nk; ++k) turned[i + ni * (j + nj * k)] = values[at++];
    return turned;
  }

  const io::Input& input_;
  ByteSource source_;
  std::string header_;
  Image image_;
};

}  // namespace

bool is_npy(std::string_view head) {
  return head.starts_with(kMagic);
}

Image read_npy(const Reading& reading) {
  return Npy(reading).read();
}

}  // namespace octafront::image
