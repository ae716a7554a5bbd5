// MetaImage: lines "Key = value", the last of which, ElementDataFile, says where the voxels are. The world is that of
// ITK: x to the left, y to the back, z up. https://itk.org/Wiki/ITK/MetaIO/Documentation

#include "formats/containers/scanner.h"
#include "images/files/image_readers.h"
#include "images/files/slice_files.h"
#include "images/files/voxels.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <fmt/core.h>

namespace octafront::image {
namespace {

std::optional<VoxelType> type_of_meta(const std::string& name) {
  static const std::map<std::string, VoxelType> kNames{
      {"MET_CHAR", VoxelType::kInt8},         {"MET_UCHAR", VoxelType::kUInt8},   {"MET_SHORT", VoxelType::kInt16},
      {"MET_USHORT", VoxelType::kUInt16},     {"MET_INT", VoxelType::kInt32},     {"MET_UINT", VoxelType::kUInt32},
      {"MET_LONG", VoxelType::kInt32},        {"MET_ULONG", VoxelType::kUInt32},  {"MET_LONG_LONG", VoxelType::kInt64},
      {"MET_ULONG_LONG", VoxelType::kUInt64}, {"MET_FLOAT", VoxelType::kFloat32}, {"MET_DOUBLE", VoxelType::kFloat64}};
  const auto found = kNames.find(name);
  return found == kNames.end() ? std::nullopt : std::optional(found->second);
}

class Meta {
 public:
  explicit Meta(const Reading& reading) : reading_(reading), input_(reading.input) {}

  Image read() {
    read_lines();
    check_kind();
    const std::vector<double> sizes = numbers("DimSize", 3);
    if (sizes.empty()) input_.fail("has no DimSize in its header; the file is damaged: export it again");
    Sizes claimed{};
    for (std::size_t i = 0; i < 3; ++i) claimed[i] = whole("DimSize", sizes[i]);
    image_.grid.size = checked_sizes(input_, claimed);
    image_.format = "MetaImage";
    image_.frame = "LPS";
    place();
    check_grid(input_, image_.grid);
    read_values();
    return std::move(image_);
  }

 private:
  struct Value {
    std::string text;
    const char* at = nullptr;
  };

  void read_lines() {
    std::size_t at = 0;
    while (at < input_.bytes.size()) {
      const std::size_t end = std::min(input_.bytes.find('\n', at), input_.bytes.size());
      const std::string_view line = io::trimmed(input_.bytes.substr(at, end - at));
      const char* const begin = input_.bytes.data() + at;
      at = std::min(end + 1, input_.bytes.size());
      const std::size_t equals = line.find('=');
      if (line.empty()) continue;
      if (equals == std::string_view::npos)
        input_.fail_at_line(begin, fmt::format("expected \"Key = value\" in the MetaImage header, found {}",
                                               io::in_quotes(line.substr(0, 60))));
      const std::string key(io::trimmed(line.substr(0, equals)));
      values_.insert_or_assign(key, Value{std::string(io::trimmed(line.substr(equals + 1))), begin});
      if (key != "ElementDataFile") continue;
      data_at_ = at;
      return;
    }
    input_.fail("has no ElementDataFile at the end of its header; the file is truncated: copy or export it again");
  }

  std::string text(const std::string& key, const std::string& otherwise = {}) const {
    const auto found = values_.find(key);
    return found == values_.end() ? otherwise : found->second.text;
  }
  const char* at(const std::string& key) const {
    const auto found = values_.find(key);
    return found == values_.end() ? input_.bytes.data() : found->second.at;
  }
  bool flag(const std::string& key) const {
    const std::string value = text(key);
    return !value.empty() && (value[0] == 'T' || value[0] == 't' || value[0] == '1');
  }

  /// As many finite numbers as there must be; none if the key is missing.
  std::vector<double> numbers(const std::string& key, std::size_t count) const {
    const auto found = values_.find(key);
    if (found == values_.end()) return {};
    std::vector<double> all;
    std::string_view rest = io::trimmed(found->second.text);
    while (!rest.empty()) {
      std::size_t end = 0;
      while (end < rest.size() && !io::is_blank(rest[end])) ++end;
      double value = 0;
      if (!io::parse_number(rest.substr(0, end), value) || !std::isfinite(value))
        input_.fail_at_line(found->second.at, fmt::format("expected a number, found {}", io::in_quotes(rest)));
      all.push_back(value);
      rest = io::trimmed(rest.substr(end));
    }
    if (all.size() != count)
      input_.fail_at_line(found->second.at,
                          fmt::format("{} has {} values, not {}; the file is damaged", key, all.size(), count));
    return all;
  }
  /// The first of several names that the header has.
  std::vector<double> numbers(std::initializer_list<const char*> keys, std::size_t count) const {
    for (const char* key : keys)
      if (values_.contains(key)) return numbers(key, count);
    return {};
  }
  std::int64_t whole(const std::string& key, double value) const {
    if (!(std::abs(value) < 1e15) || value != std::floor(value))
      input_.fail_at_line(at(key), fmt::format("{} is {}, not a whole number; the file is damaged", key, value));
    return static_cast<std::int64_t>(value);
  }
  std::int64_t whole_of(const std::string& key, std::int64_t otherwise) const {
    const std::vector<double> all = numbers(key, 1);
    return all.empty() ? otherwise : whole(key, all[0]);
  }

  void check_kind() {
    if (const std::string type = text("ObjectType", "Image"); type != "Image")
      input_.fail_at_line(at("ObjectType"), fmt::format("holds {}, not an image", io::in_quotes(type)));
    const std::int64_t dimension = whole_of("NDims", 0);
    if (dimension == 1 || dimension == 2) fail_flat(input_);
    if (dimension != 3)
      input_.fail_at_line(at("NDims"), fmt::format("has {} dimensions; three are read here", dimension));
    if (const std::int64_t channels = whole_of("ElementNumberOfChannels", 1); channels != 1)
      input_.fail_at_line(at("ElementNumberOfChannels"),
                          fmt::format("has {} values per voxel; convert it to a scalar image first", channels));
    for (const auto& [key, none] :
         {std::pair{"ElementToIntensityFunctionSlope", 1.0}, {"ElementToIntensityFunctionOffset", 0.0}})
      if (const std::vector<double> v = numbers(key, 1); !v.empty() && v[0] != none)
        image_.notes.push_back(fmt::format("{} is passed over, as ITK does", key));
  }

  void place() {
    ImageGrid& grid = image_.grid;
    std::vector<double> spacing = numbers({"ElementSpacing", "ElementSize"}, 3);
    if (spacing.empty()) {
      spacing = {1, 1, 1};
      image_.notes.emplace_back("the header has no spacing; 1 is taken");
    }
    // One axis of voxels after the other.
    const std::vector<double> m = numbers({"TransformMatrix", "Rotation", "Orientation"}, 9);
    for (std::size_t i = 0; i < 3; ++i) {
      Vec3 direction;
      direction[static_cast<int>(i)] = 1;
      if (!m.empty()) direction = {m[3 * i], m[3 * i + 1], m[3 * i + 2]};
      grid.axes[i] = direction * spacing[i];
    }
    const std::vector<double> origin = numbers({"Offset", "Position", "Origin"}, 3);
    if (!origin.empty()) grid.origin = {origin[0], origin[1], origin[2]};
    if (text("DistanceUnits") == "mm" || text("DistanceUnits") == "um" || text("DistanceUnits") == "cm")
      image_.unit = text("DistanceUnits");
  }

  StoredVoxels stored() const {
    const std::string name = text("ElementType");
    const std::optional<VoxelType> type = type_of_meta(name);
    if (!type)
      input_.fail_at_line(at("ElementType"),
                          fmt::format("ElementType {} is no type of voxels that is read here", io::in_quotes(name)));
    StoredVoxels s;
    s.type = *type;
    s.big_endian = flag("BinaryDataByteOrderMSB") || flag("ElementByteOrderMSB");
    return s;
  }

  void read_values() {
    const std::string file = text("ElementDataFile");
    const bool is_local = file == "LOCAL" || file == "Local" || file == "local";
    const bool is_text = values_.contains("BinaryData") && !flag("BinaryData");
    const std::uint64_t voxels = image_.grid.voxels();
    if (is_text) {
      if (!is_local) input_.fail_at_line(at("BinaryData"), "voxels as text in another file are not read here");
      image_.format += ", text";
      image_.values =
          read_text_voxels(input_, input_.bytes.data() + data_at_, image_.grid.size, stored().type, image_.notes);
      return;
    }
    DataFiles how;
    if (flag("CompressedData")) {
      how.packing = Packing::kZlib;
      image_.format += ", compressed";
    }
    const std::int64_t header = whole_of("HeaderSize", 0);
    how.at_end = header < 0;
    how.skipped_bytes = static_cast<std::uint64_t>(std::max<std::int64_t>(0, header));
    const Picked all{0, voxels, 1};
    if (is_local) {
      how.skipped_bytes = 0;
      image_.values = read_attached(reading_, data_at_, how, voxels, all, stored(), image_.notes);
      return;
    }
    how.names = names_of(file);
    image_.values = read_data_files(reading_, how, voxels, all, stored(), image_.notes);
  }

  std::vector<std::string> names_of(const std::string& file) const {
    if (file.starts_with("LIST")) return listed();
    std::vector<std::string> words;
    for (std::string_view rest = io::trimmed(file); !rest.empty();) {
      std::size_t end = 0;
      while (end < rest.size() && !io::is_blank(rest[end])) ++end;
      words.emplace_back(rest.substr(0, end));
      rest = io::trimmed(rest.substr(end));
    }
    if (words.size() < 3 || words[0].find('%') == std::string::npos) return {file};
    const auto number = [&](std::size_t i) {
      double value = 0;
      if (!io::parse_number(words[i], value)) value = std::nan("");
      return whole("ElementDataFile", value);
    };
    return numbered_names(input_, words[0], number(1), number(2), words.size() > 3 ? number(3) : 1);
  }

  std::vector<std::string> listed() const {
    std::vector<std::string> names;
    for (std::size_t begin = data_at_; begin < input_.bytes.size();) {
      const std::size_t end = std::min(input_.bytes.find('\n', begin), input_.bytes.size());
      const std::string_view line = io::trimmed(input_.bytes.substr(begin, end - begin));
      if (!line.empty()) names.emplace_back(line);
      begin = end + 1;
    }
    return names;
  }

  const Reading& reading_;
  const io::Input& input_;
  std::map<std::string, Value> values_;
  std::size_t data_at_ = 0;
  Image image_;
};

}  // namespace

bool is_meta(std::string_view head) {
  // Other files may have lines with "="; these keys only MetaImage has.
  const std::string_view begin = io::trimmed(head.substr(0, 64));
  return (begin.starts_with("ObjectType") || begin.starts_with("NDims") || begin.starts_with("Comment")) &&
         head.find("DimSize") != std::string_view::npos && head.find("Element") != std::string_view::npos;
}

Image read_meta(const Reading& reading) {
  return Meta(reading).read();
}

}  // namespace octafront::image
