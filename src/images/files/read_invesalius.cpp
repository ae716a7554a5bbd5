// InVesalius projects (.inv3): a tar, compressed by gzip or not, of property lists and raw arrays. main.plist names the
// array of the image, and the property lists of masks, which have a plane, a row and a column of flags before the
// voxels.

#include "formats/containers/scanner.h"
#include "images/files/grids.h"
#include "images/files/plist.h"
#include "images/files/readers.h"

#include <cmath>
#include <functional>
#include <map>
#include <optional>

#include <fmt/core.h>

namespace octafront::image {
namespace {

constexpr std::uint64_t kTarBlock = 512;

/// A file of a tar.
struct Entry {
  std::string name;  ///< without folders
  std::uint64_t size = 0;
};

class Project {
 public:
  explicit Project(const Reading& reading) : reading_(reading), input_(reading.input) {}

  Image read() {
    read_lists();
    const auto main = lists_.find("main.plist");
    if (main == lists_.end()) input_.fail("is an archive without main.plist: no InVesalius project");
    const Plist project = parsed(*main);
    const std::vector<Plist> masks = masks_of(project);
    const std::uint32_t wanted = reading_.choice.series == 0 ? 0 : chosen_series(reading_, 1 + masks.size(), "images");
    image_.format = "InVesalius project";
    place(project, shape(project.at("matrix").at("shape")));
    if (wanted == 0) {
      list_masks(masks);
      read_matrix(project.at("matrix"));
    } else {
      read_mask(masks[wanted - 1]);
    }
    return std::move(image_);
  }

 private:
  /// Visits the files of the archive; what `visit` leaves unread of a file is passed over.
  void for_each_file(const std::function<bool(const Entry&, ByteSource&)>& visit) const {
    ByteSource source(input_, 0, Packing::kDetect);
    for (;;) {
      const std::string header(source.take(kTarBlock));
      if (header.size() < kTarBlock || header.find_first_not_of('\0') == std::string::npos) return;
      Entry entry{header.substr(0, 100), octal(source, header.substr(124, 12))};
      entry.name.resize(std::min(entry.name.find('\0'), entry.name.size()));
      entry.name.erase(0, entry.name.rfind('/') + 1);
      const std::uint64_t padded = (entry.size + kTarBlock - 1) / kTarBlock * kTarBlock;
      const bool is_file = header[156] == '0' || header[156] == '\0';
      if (is_file && visit(entry, source)) {
        source.skip(padded - entry.size, "the archive");
      } else {
        source.skip(padded, "the archive");
      }
    }
  }

  static std::uint64_t octal(const ByteSource& source, std::string_view text) {
    std::uint64_t value = 0;
    for (const char c : text) {
      if (c == ' ' || c == '\0') continue;
      if (c < '0' || c > '7') source.fail("expected the size of a file in the archive; the file is damaged");
      value = value * 8 + static_cast<std::uint64_t>(c - '0');
    }
    return value;
  }

  void read_lists() {
    constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 24;
    for_each_file([&](const Entry& entry, ByteSource& source) {
      if (!entry.name.ends_with(".plist") || entry.size > kMostBytes) return false;
      lists_.insert_or_assign(entry.name, std::string(source.require(entry.size, entry.name)));
      return true;
    });
  }

  Plist parsed(const std::pair<const std::string, std::string>& list) const {
    return parse_plist({fmt::format("{} ({})", input_.name, list.first), list.second});
  }

  std::vector<Plist> masks_of(const Plist& project) const {
    std::map<double, Plist> by_number;
    for (const auto& [number, name] : project.at("masks").dictionary) {
      const auto list = lists_.find(name.text);
      double n = 0;
      if (list != lists_.end() && io::parse_number(number, n)) by_number.emplace(n, parsed(*list));
    }
    std::vector<Plist> masks;
    for (auto& [number, mask] : by_number) masks.push_back(std::move(mask));
    return masks;
  }

  void list_masks(const std::vector<Plist>& masks) {
    std::string names;
    for (std::size_t i = 0; i < masks.size(); ++i)
      names += fmt::format("{}{} \"{}\"", i == 0 ? "" : ", ", i + 2, masks[i].at("name").text);
    if (!masks.empty())
      image_.notes.push_back(
          fmt::format("the image is taken; the project's masks are chosen by number: {} (`series`)", names));
  }

  double number(const Plist& value, std::string_view what) const {
    double n = 0;
    if (!io::parse_number(value.text, n) || !std::isfinite(n))
      input_.fail(fmt::format("has no number for {} in its property lists; the project is damaged", what));
    return n;
  }

  /// Slices, rows, columns become columns, rows, slices.
  Sizes shape(const Plist& list) const {
    if (list.array.size() != 3) input_.fail("has no shape of three numbers in its property lists");
    Sizes sizes{};
    for (std::size_t i = 0; i < 3; ++i) {
      const double n = number(list.array[2 - i], "the shape");
      if (n != std::floor(n) || std::abs(n) > 1e15) input_.fail("has a shape that is no whole number");
      sizes[i] = static_cast<std::int64_t>(n);
    }
    return sizes;
  }

  void place(const Plist& project, const Sizes& sizes) {
    image_.grid.size = checked_sizes(input_, sizes);
    const Plist& spacing = project.at("spacing");
    if (spacing.array.size() != 3) input_.fail("has no spacing of three numbers in main.plist");
    for (std::size_t i = 0; i < 3; ++i)
      image_.grid.axes[i][static_cast<int>(i)] = number(spacing.array[i], "the spacing");
    // InVesalius' own surfaces have y turned: its rows run from the back of the patient to the front.
    image_.grid.axes[1] = image_.grid.axes[1] * -1.0;
    image_.unit = "mm";
    image_.frame = "LPS";
    check_grid(input_, image_.grid);
  }

  static std::optional<VoxelType> type_of(const std::string& name) {
    const std::map<std::string, VoxelType> types{{"int8", VoxelType::kInt8},       {"uint8", VoxelType::kUInt8},
                                                 {"int16", VoxelType::kInt16},     {"uint16", VoxelType::kUInt16},
                                                 {"int32", VoxelType::kInt32},     {"uint32", VoxelType::kUInt32},
                                                 {"float32", VoxelType::kFloat32}, {"float64", VoxelType::kFloat64}};
    const auto found = types.find(name);
    return found == types.end() ? std::nullopt : std::optional(found->second);
  }

  /// The voxels of a file of the archive.
  Image::Values array(const std::string& name, const std::array<std::uint32_t, 3>& size, VoxelType type) {
    std::optional<Image::Values> values;
    for_each_file([&](const Entry& entry, ByteSource& source) {
      if (values || entry.name != name) return false;
      const std::uint64_t bytes = std::uint64_t{size[0]} * size[1] * size[2] * bytes_of(type);
      if (entry.size != bytes)
        source.fail(fmt::format("{} has {} bytes, but {} voxels take {}; the project is damaged", name, entry.size,
                                in_words(size), bytes));
      values = read_voxels(source, size, {type, false, 1, 0}, image_.notes);
      return true;
    });
    if (!values) input_.fail(fmt::format("has no file {}, which its property lists name", io::in_quotes(name)));
    return std::move(*values);
  }

  void read_matrix(const Plist& matrix) {
    const std::optional<VoxelType> type = type_of(matrix.at("dtype").text);
    if (!type)
      input_.fail(
          fmt::format("has voxels of the type {}, which is not read here", io::in_quotes(matrix.at("dtype").text)));
    image_.values = array(matrix.at("filename").text, image_.grid.size, *type);
  }

  // Voxels of the mask are 254 or 255, edited ones and those of the threshold; 0 and 1 lie outside.
  void read_mask(const Plist& mask) {
    const std::array<std::uint32_t, 3> size = image_.grid.size;
    const std::array<std::uint32_t, 3> with_flags = checked_sizes(input_, shape(mask.at("mask_shape")));
    for (std::size_t i = 0; i < 3; ++i)
      if (with_flags[i] != size[i] + 1)
        input_.fail("has a mask of another shape than its image; the project is damaged");
    const Image::Values all = array(mask.at("mask_file").text, with_flags, VoxelType::kUInt8);
    const auto& flagged = std::get<std::vector<std::uint8_t>>(all);
    constexpr std::uint8_t kInside = 128;
    std::vector<std::uint8_t> inside;
    inside.reserve(image_.grid.voxels());
    for (std::uint32_t k = 1; k <= size[2]; ++k)
      for (std::uint32_t j = 1; j <= size[1]; ++j)
        for (std::uint32_t i = 1; i <= size[0]; ++i)
          inside.push_back(flagged[i + with_flags[0] * (j + std::size_t{with_flags[1]} * k)] >= kInside);
    image_.values = std::move(inside);
    image_.names = {{1, mask.at("name").text}};
    image_.notes.push_back(fmt::format("the mask \"{}\" is taken", mask.at("name").text));
  }

  const Reading& reading_;
  const io::Input& input_;
  std::map<std::string, std::string> lists_;
  Image image_;
};

}  // namespace

bool is_invesalius(std::string_view head) {
  return head.size() >= kTarBlock && head.substr(257, 5) == "ustar";
}

Image read_invesalius(const Reading& reading) {
  return Project(reading).read();
}

}  // namespace octafront::image
