// INRIMAGE-4: a header of 256 bytes, or a multiple of it, in lines KEY=value, then voxels.

#include "base/core/elementary.h"
#include "formats/containers/scanner.h"
#include "images/files/byte_source.h"
#include "images/files/grids.h"
#include "images/files/readers.h"

#include <cmath>
#include <map>

#include <fmt/core.h>

namespace octafront::image {
namespace {

constexpr std::string_view kMagic = "#INRIMAGE-4#{";
constexpr std::size_t kHeaderBlock = 256;

class Inr {
 public:
  explicit Inr(const Reading& reading) : input_(reading.input), source_(input_, 0, Packing::kDetect) {}

  Image read() {
    read_header();
    if (whole("VDIM", 1) != 1)
      input_.fail(fmt::format("has {} values per voxel; convert it to a scalar image first", whole("VDIM", 1)));
    image_.grid.size = checked_sizes(input_, {whole("XDIM", 0), whole("YDIM", 0), whole("ZDIM", 1)});
    const char* const spacing[] = {"VX", "VY", "VZ"};
    const char* const origin[] = {"TX", "TY", "TZ"};
    for (int i = 0; i < 3; ++i) {
      image_.grid.axes[static_cast<std::size_t>(i)][i] = real(spacing[i], 1);
      image_.grid.origin[i] = real(origin[i], 0);
    }
    for (const char* key : {"RX", "RY", "RZ"})
      if (real(key, 0) != 0) image_.notes.push_back(fmt::format("its rotation {} is passed over", key));
    check_grid(input_, image_.grid);
    image_.format = std::string("INR") + (source_.is_packed() ? ", compressed" : "");
    image_.values = read_voxels(source_, image_.grid.size, stored(), image_.notes);
    source_.check_end();
    return std::move(image_);
  }

 private:
  void read_header() {
    constexpr std::size_t kMostBlocks = 64;
    std::string header;
    while (header.find("##}") == std::string::npos) {
      if (header.size() == kMostBlocks * kHeaderBlock)
        input_.fail("the INR header has no end (##}); the file is damaged");
      header += source_.require(kHeaderBlock, "the INR header");
    }
    for (std::size_t at = 0; at < header.size();) {
      const std::size_t end = std::min(header.find('\n', at), header.size());
      const std::string_view line = std::string_view(header).substr(at, end - at);
      const std::size_t equals = line.find('=');
      if (!line.starts_with('#') && equals != std::string_view::npos)
        keys_.emplace(line.substr(0, equals), trimmed(line.substr(equals + 1)));
      at = end + 1;
    }
  }

  static std::string trimmed(std::string_view text) {
    while (!text.empty() && io::is_blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && io::is_blank(text.back())) text.remove_suffix(1);
    return std::string(text);
  }

  double real(const std::string& key, double otherwise) const {
    const auto found = keys_.find(key);
    if (found == keys_.end()) return otherwise;
    double value = 0;
    if (!io::parse_number(found->second, value) || !std::isfinite(value))
      input_.fail(
          fmt::format("{} is {} in its header, not a number; the file is damaged", key, io::in_quotes(found->second)));
    return value;
  }

  std::int64_t whole(const std::string& key, double otherwise) const {
    const double value = real(key, otherwise);
    if (value != std::floor(value) || std::abs(value) > 1e15)
      input_.fail(fmt::format("{} is {} in its header, not a whole number; the file is damaged", key, value));
    return static_cast<std::int64_t>(value);
  }

  std::string text(const std::string& key) const {
    const auto found = keys_.find(key);
    return found == keys_.end() ? "" : found->second;
  }

  StoredVoxels stored() const {
    const std::string type = text("TYPE"), cpu = text("CPU"), bits = text("PIXSIZE");
    StoredVoxels s;
    s.big_endian = cpu == "sun" || cpu == "sgi";
    if (!s.big_endian && cpu != "decm" && cpu != "alpha" && cpu != "pc" && !cpu.empty())
      input_.fail(fmt::format("CPU is {} in its header; expected decm, alpha, pc, sun or sgi", io::in_quotes(cpu)));
    const bool is_float = type == "float", is_signed = type == "signed fixed";
    if (!is_float && !is_signed && type != "unsigned fixed")
      input_.fail(fmt::format("TYPE is {} in its header; expected \"unsigned fixed\", \"signed fixed\" or \"float\"",
                              io::in_quotes(type)));
    const std::string number = bits.substr(0, bits.find(' '));
    if (number == "8" && !is_float) {
      s.type = is_signed ? VoxelType::kInt8 : VoxelType::kUInt8;
    } else if (number == "16" && !is_float) {
      s.type = is_signed ? VoxelType::kInt16 : VoxelType::kUInt16;
    } else if (number == "32") {
      s.type = is_float ? VoxelType::kFloat32 : is_signed ? VoxelType::kInt32 : VoxelType::kUInt32;
    } else if (number == "64") {
      s.type = is_float ? VoxelType::kFloat64 : is_signed ? VoxelType::kInt64 : VoxelType::kUInt64;
    } else {
      input_.fail(fmt::format("PIXSIZE is {} in its header; expected 8, 16, 32 or 64 bits", io::in_quotes(bits)));
    }
    if (!is_float) s.slope = scale();
    return s;
  }

  /// "2**-8" for numbers with a binary point.
  double scale() const {
    const std::string scale = text("SCALE");
    if (!scale.starts_with("2**")) return 1;
    double power = 0;
    if (!io::parse_number(scale.substr(3), power) || !(std::abs(power) <= 64)) return 1;
    return elementary::exp2(power);
  }

  const io::Input& input_;
  ByteSource source_;
  std::map<std::string, std::string> keys_;
  Image image_;
};

}  // namespace

bool is_inr(std::string_view head) {
  return head.starts_with(kMagic);
}

Image read_inr(const Reading& reading) {
  return Inr(reading).read();
}

}  // namespace octafront::image
