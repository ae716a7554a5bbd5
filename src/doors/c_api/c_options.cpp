#include <octafront/error.h>
#include <octafront/generate.h>
#include <octafront/io.h>
#include <octafront/named_groups.h>
#include <octafront/option_table.h>
#include <octafront/units.h>

#include "doors/c_api/c_api.h"
#include "doors/c_api/json_keys.h"
#include "sizing/field/packed_sizes.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include <fmt/core.h>

namespace octafront::c_api {

namespace {

using Json = nlohmann::ordered_json;

Json json_of_value(const OptionValue& value) {
  return std::visit(
      [](const auto& v) -> Json {
        if constexpr (std::is_same_v<std::decay_t<decltype(v)>, std::monostate>)
          return nullptr;
        else
          return v;
      },
      value);
}

const char* name_of_kind(OptionInfo::Kind kind) {
  switch (kind) {
    case OptionInfo::Kind::kNumber:
      return "number";
    case OptionInfo::Kind::kWhole:
      return "whole";
    case OptionInfo::Kind::kFlag:
      return "flag";
    case OptionInfo::Kind::kChoice:
      return "choice";
    case OptionInfo::Kind::kText:
      return "text";
  }
  return "";
}

template <class All>
std::string described(const std::vector<OptionInfo>& table) {
  Json all = Json::array();
  const All defaults;
  for (const OptionInfo& info : table) {
    all.push_back({{"name", info.name},
                   {"field", info.field},
                   {"group", info.group},
                   {"tasks", info.tasks},
                   {"kind", name_of_kind(info.kind)},
                   {"choices", info.choices},
                   {"default", json_of_value(option_value(defaults, info.name))},
                   {"without", info.unset},
                   {"range", info.range()},
                   {"is_length", info.is_length},
                   {"help", info.help}});
  }
  return all.dump();
}

std::string described_formats() {
  Json all = Json::array();
  for (const FormatInfo& info : known_formats()) {
    all.push_back({{"name", info.name},
                   {"title", info.title},
                   {"endings", info.endings},
                   {"reads_surface", info.reads_surface},
                   {"writes_surface", info.writes_surface},
                   {"reads_mesh", info.reads_mesh},
                   {"writes_mesh", info.writes_mesh},
                   {"carries", info.carries}});
  }
  return all.dump();
}

std::string described_units() {
  Json all = Json::array();
  for (const LengthUnit& unit : length_units())
    all.push_back({{"name", unit.name}, {"metres", unit.metres}, {"words", unit.words}});
  return all.dump();
}

}  // namespace

OptionValue value_of(const std::string& name, const Json& json) {
  if (json.is_null()) return {};
  if (json.is_boolean()) return json.get<bool>();
  if (json.is_number_unsigned() && json.get<std::uint64_t>() > INT64_MAX) return json.get<double>();
  if (json.is_number_integer()) return json.get<std::int64_t>();
  if (json.is_number()) return json.get<double>();
  if (json.is_string()) return json.get<std::string>();
  throw OptionError(fmt::format("`{}` needs a single value", name));
}

}  // namespace octafront::c_api

using namespace octafront;
using namespace octafront::c_api;

const char* octafront_option_table() {
  static const std::string text = described<Options>(option_table());
  return text.c_str();
}

const char* octafront_intake_table() {
  static const std::string text = described<IntakeOptions>(intake_table());
  return text.c_str();
}

const char* octafront_formats() {
  static const std::string text = described_formats();
  return text.c_str();
}

const char* octafront_units() {
  static const std::string text = described_units();
  return text.c_str();
}

const char* octafront_unit_of_file(const char* file) {
  const char* unit = nullptr;
  guarded([&] { unit = kept(unit_of_file(file)); });
  return unit;
}

octafront_options* octafront_options_new() {
  return new octafront_options;
}

void octafront_options_free(octafront_options* options) {
  delete options;
}

int octafront_options_set(octafront_options* options, const char* json) {
  return guarded([&] {
    const Json given = Json::parse(json);
    for (const auto& [name, value] : given.items()) set_option(options->options, name, value_of(name, value));
  });
}

int octafront_options_regions(octafront_options* options, const double* rows, size_t n) {
  return guarded([&] {
    for (const double* r = rows; r != rows + 8 * n; r += 8)
      options->options.size.regions.push_back({{r[0], r[1], r[2]}, {r[3], r[4], r[5]}, r[6], r[7]});
  });
}

int octafront_options_point_sizes(octafront_options* options, const double* rows, size_t n) {
  return guarded([&] {
    for (const double* r = rows; r != rows + 4 * n; r += 4)
      options->options.size.point_sizes.push_back({{r[0], r[1], r[2]}, r[3]});
  });
}

int octafront_options_regions_file(octafront_options* options, const char* file) {
  return guarded([&] { options->options.size.regions = read_size_regions(file); });
}

int octafront_options_point_sizes_file(octafront_options* options, const char* file) {
  return guarded([&] { options->options.size.point_sizes = read_point_sizes(file); });
}

int octafront_options_size_of(octafront_options* options, const char* name, size_t length, double size) {
  return guarded([&] { options->options.size.named.push_back({std::string(name, length), size}); });
}

int octafront_options_group(octafront_options* options, const char* text, size_t length) {
  return guarded([&] {
    group_rule(std::string(text, length));  // refused at once if it is none
    options->options.groups.emplace_back(text, length);
  });
}

int octafront_options_size_near(octafront_options* options, const char* name, size_t length, const double* point,
                                double size, double distance) {
  return guarded([&] {
    NearSize near{name == nullptr ? std::string() : std::string(name, length), {}, size, distance};
    if (near.name.empty()) {
      if (point == nullptr) throw OptionError("`size_near` needs a name or a point");
      near.point = {point[0], point[1], point[2]};
    }
    options->options.size.near.push_back(std::move(near));
  });
}

int octafront_options_sizes_file(octafront_options* options, const char* named) {
  return guarded([&] { read_sizes_into(options->options.size, named); });
}

int octafront_options_size_mesh(octafront_options* options, const double* points, size_t n, const uint32_t* elements,
                                size_t count, uint32_t corners, const double* sizes, int of_elements) {
  return guarded([&] {
    if (corners != 3 && corners != 4) throw OptionError(fmt::format("elements have 3 or 4 corners, not {}", corners));
    SizeMesh mesh;
    mesh.name = "an array";
    for (std::size_t i = 0; i < n; ++i) mesh.points.push_back({points[3 * i], points[3 * i + 1], points[3 * i + 2]});
    for (const uint32_t* e = elements; e != elements + corners * count; e += corners)
      if (corners == 4)
        mesh.tets.push_back({e[0], e[1], e[2], e[3]});
      else
        mesh.triangles.push_back({e[0], e[1], e[2]});
    (of_elements != 0 ? mesh.element_sizes : mesh.point_sizes).assign(sizes, sizes + (of_elements != 0 ? count : n));
    options->options.size.mesh = std::make_shared<const SizeMesh>(std::move(mesh));
  });
}

int octafront_options_field(octafront_options* options, const octafront_sizes* sizes) {
  return guarded([&] { options->options.size.field = sizes->field; });
}

void octafront_options_for_voxels(octafront_options* options, double spacing) {
  options->options = options_for_voxels(std::move(options->options), spacing);
}

int octafront_options_ranks(octafront_options* options, int rank, int size) {
  return guarded([&] {
    if (rank < 0 || rank >= size) throw OptionError(fmt::format("there is no rank {} of {}", rank, size));
    options->rank = rank, options->ranks = size;
  });
}

void octafront_options_ask_sizes(octafront_options* options) {
  options->asks_sizes = true;
}

void octafront_options_tell_passes(octafront_options* options) {
  options->tells_passes = true;
}

void octafront_sizes_free(octafront_sizes* sizes) {
  delete sizes;
}

int octafront_sizes_at(const octafront_sizes* sizes, const double* points, size_t n, double* out) {
  return guarded([&] {
    for (std::size_t i = 0; i < n; ++i) out[i] = sizes->field.at({points[3 * i], points[3 * i + 1], points[3 * i + 2]});
  });
}

int octafront_sizes_metric_at(const octafront_sizes* sizes, const double* points, size_t n, double* out) {
  return guarded([&] {
    for (std::size_t i = 0; i < n; ++i)
      for (const auto& row : sizes->field.metric_at({points[3 * i], points[3 * i + 1], points[3 * i + 2]}))
        out = std::copy(row.begin(), row.end(), out);
  });
}

void octafront_sizes_bounds(const octafront_sizes* sizes, double* least, double* largest) {
  *least = sizes->field.min_size();
  *largest = sizes->field.max_size();
}

octafront_sizes* octafront_sizes_uniform(double h) {
  octafront_sizes* made = nullptr;
  guarded([&] {
    if (!(h > 0)) throw OptionError(fmt::format("a size must be above 0, but is {}", h));
    made = new octafront_sizes{SizeField::uniform(h)};
  });
  return made;
}

int octafront_sizes_pack(const octafront_sizes* sizes, const char** bytes, size_t* length) {
  return guarded([&] {
    std::string packed = packed_sizes(sizes->field);
    *length = packed.size();
    *bytes = kept(std::move(packed));
  });
}

octafront_sizes* octafront_sizes_unpack(const char* bytes, size_t length) {
  octafront_sizes* made = nullptr;
  guarded([&] { made = new octafront_sizes{unpacked_sizes({bytes, length})}; });
  return made;
}
