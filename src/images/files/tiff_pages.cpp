// TIFF by libtiff: pages in memory, of one grey value per pixel, whatever packs them. ImageJ says in the description
// how far slices are apart, and of what unit.

#include "images/files/tiff_pages.h"

#include "formats/containers/scanner.h"
#include "images/files/voxels.h"

#include <algorithm>
#include <cstring>
#include <memory>

#include <fmt/core.h>
#include <tiffio.h>

namespace octafront::image {
namespace {

/// What libtiff reads from.
struct Bytes {
  std::string_view all;
  std::uint64_t at = 0;
};

tmsize_t read_bytes(thandle_t handle, void* to, tmsize_t count) {
  auto& bytes = *static_cast<Bytes*>(handle);
  const std::uint64_t left = bytes.at < bytes.all.size() ? bytes.all.size() - bytes.at : 0;
  const auto n = std::min<std::uint64_t>(static_cast<std::uint64_t>(count), left);
  std::memcpy(to, bytes.all.data() + bytes.at, n);
  bytes.at += n;
  return static_cast<tmsize_t>(n);
}
tmsize_t write_nothing(thandle_t, void*, tmsize_t) {
  return -1;
}
toff_t seek(thandle_t handle, toff_t offset, int from) {
  auto& bytes = *static_cast<Bytes*>(handle);
  bytes.at = (from == SEEK_CUR ? bytes.at : from == SEEK_END ? bytes.all.size() : 0) + offset;
  return bytes.at;
}
int close_nothing(thandle_t) {
  return 0;
}
toff_t size_of(thandle_t handle) {
  return static_cast<Bytes*>(handle)->all.size();
}

class Pages {
 public:
  explicit Pages(const io::Input& input) : input_(input), bytes_{input.bytes} {
    TIFFSetWarningHandler(nullptr), TIFFSetErrorHandler(nullptr);
    tiff_.reset(TIFFClientOpen(input.name.c_str(), "rm", &bytes_, read_bytes, write_nothing, seek, close_nothing,
                               size_of, nullptr, nullptr));
    if (!tiff_) input.fail("is a TIFF file that cannot be opened; it is damaged: copy or export it again");
  }

  TiffPages read() {
    do {
      input_.context.check();
      check_page();
      read_page();
    } while (TIFFReadDirectory(tiff_.get()) != 0);
    return std::move(pages_);
  }

 private:
  struct Close {
    void operator()(TIFF* tiff) const { TIFFClose(tiff); }
  };

  template <class T>
  T tag(std::uint32_t id, T otherwise) const {
    T value = otherwise;
    return TIFFGetFieldDefaulted(tiff_.get(), id, &value) == 1 ? value : otherwise;
  }

  void check_page() {
    const auto columns = tag<std::uint32_t>(TIFFTAG_IMAGEWIDTH, 0), rows = tag<std::uint32_t>(TIFFTAG_IMAGELENGTH, 0);
    const auto samples = tag<std::uint16_t>(TIFFTAG_SAMPLESPERPIXEL, 1);
    if (samples != 1) input_.fail(fmt::format("has {} values per pixel (colours); a grey image is needed", samples));
    const std::optional<VoxelType> type = type_of_page();
    if (!type) input_.fail("has pixels that are no whole numbers of 8, 16 or 32 bits, nor of floating point");
    if (pages_.size[2] == 0) {
      pages_.size = {columns, rows, 0};
      pages_.stored.type = *type;
      describe();
    }
    if (pages_.size[0] != columns || pages_.size[1] != rows || pages_.stored.type != *type)
      input_.fail(fmt::format("page {} has {} x {} pixels, others {} x {}: pages that are alike are read",
                              pages_.size[2] + 1, columns, rows, pages_.size[0], pages_.size[1]));
    require_memory_for(input_, std::uint64_t{columns} * rows * static_cast<std::uint64_t>(pages_.size[2] + 1), *type);
  }

  std::optional<VoxelType> type_of_page() const {
    const auto bits = tag<std::uint16_t>(TIFFTAG_BITSPERSAMPLE, 1), kind = tag<std::uint16_t>(TIFFTAG_SAMPLEFORMAT, 1);
    const bool is_signed = kind == SAMPLEFORMAT_INT, is_real = kind == SAMPLEFORMAT_IEEEFP;
    if (bits == 64 && is_real) return VoxelType::kFloat64;
    if (bits == 32) return is_real ? VoxelType::kFloat32 : is_signed ? VoxelType::kInt32 : VoxelType::kUInt32;
    if (bits == 16 && !is_real) return is_signed ? VoxelType::kInt16 : VoxelType::kUInt16;
    if (bits == 8 && !is_real) return is_signed ? VoxelType::kInt8 : VoxelType::kUInt8;
    return std::nullopt;
  }

  /// Resolutions count pixels per unit; ImageJ's description has lines "spacing=0.5" and "unit=mm".
  void describe() {
    for (const auto& [axis, id] : {std::pair{0, TIFFTAG_XRESOLUTION}, {1, TIFFTAG_YRESOLUTION}})
      if (const float per_unit = tag<float>(static_cast<std::uint32_t>(id), 0); per_unit > 0)
        pages_.spacing[static_cast<std::size_t>(axis)] = 1 / static_cast<double>(per_unit);
    const auto unit = tag<std::uint16_t>(TIFFTAG_RESOLUTIONUNIT, RESUNIT_NONE);
    constexpr double kInch = 25.4, kCentimetre = 10;
    char* text = nullptr;
    const bool has_text = TIFFGetField(tiff_.get(), TIFFTAG_IMAGEDESCRIPTION, &text) == 1 && text != nullptr;
    const std::string description = has_text ? text : "";
    if (description.starts_with("ImageJ")) {
      double between = 0;
      if (io::parse_number(behind(description, "\nspacing="), between) && between > 0) pages_.spacing[2] = between;
      pages_.unit = behind(description, "\nunit=");
    } else if (unit == RESUNIT_INCH || unit == RESUNIT_CENTIMETER) {
      for (double& s : pages_.spacing) s *= unit == RESUNIT_INCH ? kInch : kCentimetre;
      pages_.unit = "mm";
    }
  }

  static std::string behind(const std::string& text, std::string_view key) {
    const std::size_t at = text.find(key);
    if (at == std::string::npos) return {};
    const std::size_t begin = at + key.size();
    return text.substr(begin, text.find('\n', begin) - begin);
  }

  void read_page() {
    const std::uint64_t row = static_cast<std::uint64_t>(pages_.size[0]) * bytes_of(pages_.stored.type);
    const std::uint64_t rows = static_cast<std::uint64_t>(pages_.size[1]);
    const std::size_t before = pages_.bytes.size();
    if (TIFFIsTiled(tiff_.get()) != 0) input_.fail("has pixels in tiles; save it in strips");
    if (static_cast<std::uint64_t>(TIFFScanlineSize64(tiff_.get())) != row)
      input_.fail("its rows have no whole pixels");
    pages_.bytes.resize(before + row * rows);
    for (std::uint32_t r = 0; r < rows; ++r)
      if (TIFFReadScanline(tiff_.get(), pages_.bytes.data() + before + r * row, r, 0) != 1)
        input_.fail(fmt::format("row {} of page {} cannot be unpacked; it is damaged: copy or export it again", r + 1,
                                pages_.size[2] + 1));
    ++pages_.size[2];
  }

  const io::Input& input_;
  Bytes bytes_;
  std::unique_ptr<TIFF, Close> tiff_;
  TiffPages pages_;
};

}  // namespace

bool has_tiff() {
  return true;
}

TiffPages tiff_pages(const io::Input& input) {
  return Pages(input).read();
}

}  // namespace octafront::image
