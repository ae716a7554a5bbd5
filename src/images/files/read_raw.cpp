// Raw voxels, and the JSON file beside them that says what they are:
//   {"size": [256, 256, 108], "type": "int16", "spacing": [0.957, 0.957, 1.5]}

#include "images/files/image_readers.h"
#include "images/files/slice_files.h"
#include "images/files/voxels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include <fmt/format.h>

namespace octafront::image {
namespace {

using Json = nlohmann::ordered_json;

const std::map<std::string, VoxelType> kTypes{{"int8", VoxelType::kInt8},       {"uint8", VoxelType::kUInt8},
                                              {"int16", VoxelType::kInt16},     {"uint16", VoxelType::kUInt16},
                                              {"int32", VoxelType::kInt32},     {"uint32", VoxelType::kUInt32},
                                              {"int64", VoxelType::kInt64},     {"uint64", VoxelType::kUInt64},
                                              {"float32", VoxelType::kFloat32}, {"float64", VoxelType::kFloat64}};

constexpr std::array kKeys{"size",   "type",  "spacing",   "origin", "directions", "endian",
                           "offset", "slope", "intercept", "unit",   "frame",      "file"};

class Raw {
 public:
  Raw(const Reading& reading, const std::string& data) : reading_(reading), input_(reading.input), data_(data) {}

  Image read() {
    parse();
    const std::array<double, 3> size = triple("size", {0, 0, 0});
    Sizes claimed{};
    for (std::size_t i = 0; i < 3; ++i) {
      if (size[i] != std::floor(size[i]) || std::abs(size[i]) > 1e15) fail("size", "three whole numbers");
      claimed[i] = static_cast<std::int64_t>(size[i]);
    }
    image_.grid.size = checked_sizes(input_, claimed);
    place();
    check_grid(input_, image_.grid);
    image_.format = "raw";
    image_.unit = text("unit", "");
    image_.frame = text("frame", "");
    DataFiles how;
    const double offset = number("offset", 0);
    if (offset != std::floor(offset) || !(offset >= 0 && offset < 1e15)) fail("offset", "a number of bytes");
    how.skipped_bytes = static_cast<std::uint64_t>(offset);
    how.names = {file()};
    how.packing = Packing::kDetect;
    const std::uint64_t voxels = image_.grid.voxels();
    image_.values = read_data_files(reading_, how, voxels, {0, voxels, 1}, stored(), image_.notes);
    return std::move(image_);
  }

 private:
  void parse() {
    try {
      json_ = Json::parse(input_.bytes);
    } catch (const Json::parse_error& e) {
      input_.fail_at_byte(input_.bytes.data() + std::min(e.byte, input_.bytes.size()), "is no valid JSON here");
    }
    if (!json_.is_object()) input_.fail("is no JSON object such as {\"size\": [64, 64, 64], \"type\": \"uint8\"}");
    for (const auto& [key, value] : json_.items())
      if (std::find(kKeys.begin(), kKeys.end(), key) == kKeys.end())
        input_.fail(fmt::format("has the key {}, which means nothing here; keys are {}", io::in_quotes(key),
                                fmt::join(kKeys, ", ")));
  }

  [[noreturn]] void fail(const std::string& key, const std::string& expected) const {
    input_.fail(fmt::format("needs {} for \"{}\"", expected, key));
  }
  double number(const std::string& key, double otherwise) const {
    if (!json_.contains(key)) return otherwise;
    if (!json_[key].is_number()) fail(key, "a number");
    return json_[key].get<double>();
  }
  std::string text(const std::string& key, const std::string& otherwise) const {
    if (!json_.contains(key)) return otherwise;
    if (!json_[key].is_string()) fail(key, "a text");
    return json_[key].get<std::string>();
  }
  std::array<double, 3> three_of(const std::string& key, const Json& value) const {
    if (!value.is_array() || value.size() != 3) fail(key, "three numbers");
    std::array<double, 3> all{};
    for (std::size_t i = 0; i < 3; ++i) {
      if (!value[i].is_number()) fail(key, "three numbers");
      all[i] = value[i].get<double>();
    }
    return all;
  }
  std::array<double, 3> triple(const std::string& key, std::array<double, 3> otherwise) const {
    return json_.contains(key) ? three_of(key, json_[key]) : otherwise;
  }

  void place() {
    const std::array<double, 3> spacing = triple("spacing", {1, 1, 1}), origin = triple("origin", {0, 0, 0});
    if (!json_.contains("spacing")) image_.notes.emplace_back("the JSON file has no spacing; 1 is taken");
    image_.grid.origin = {origin[0], origin[1], origin[2]};
    const bool has_directions = json_.contains("directions");
    if (has_directions && (!json_["directions"].is_array() || json_["directions"].size() != 3))
      fail("directions", "three vectors");
    for (std::size_t i = 0; i < 3; ++i) {
      Vec3 direction;
      direction[static_cast<int>(i)] = 1;
      if (has_directions) {
        const std::array<double, 3> d = three_of("directions", json_["directions"][i]);
        direction = {d[0], d[1], d[2]};
      }
      image_.grid.axes[i] = direction * spacing[i];
    }
  }

  StoredVoxels stored() const {
    const auto type = kTypes.find(text("type", ""));
    if (type == kTypes.end())
      fail("type", "one of int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64");
    const std::string endian = text("endian", "little");
    if (endian != "little" && endian != "big") fail("endian", "\"little\" or \"big\"");
    return {type->second, endian == "big", number("slope", 1), number("intercept", 0)};
  }

  /// The file that was given, or named, or scan.raw for scan.json and for scan.raw.json.
  std::string file() const {
    if (!data_.empty()) return data_;
    if (json_.contains("file")) return text("file", "");
    const std::filesystem::path stem = std::filesystem::path(input_.name).stem();
    return stem.has_extension() ? stem.string() : stem.string() + ".raw";
  }

  const Reading& reading_;
  const io::Input& input_;
  std::string data_;
  Json json_;
  Image image_;
};

}  // namespace

bool is_raw_header(std::string_view head) {
  const std::size_t first = head.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && head[first] == '{' && head.find("\"size\"") != std::string_view::npos &&
         head.find("\"type\"") != std::string_view::npos;
}

Image read_raw(const Reading& reading, const std::string& data) {
  return Raw(reading, data).read();
}

}  // namespace octafront::image
