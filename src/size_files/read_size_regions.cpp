#include <octafront/io.h>

#include "io/input.h"
#include "size_files/point_table.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include <fmt/format.h>

namespace octafront {

namespace {

using Json = nlohmann::json;

[[noreturn]] void fail_at(const io::Input& input, std::size_t entry, const std::string& reason) {
  input.fail(fmt::format("entry {} {}", entry, reason));
}

double number(const io::Input& input, std::size_t entry, const Json& value, const char* name) {
  if (!value.is_number()) fail_at(input, entry, fmt::format("needs a number for \"{}\"", name));
  return value.get<double>();
}

Vec3 point(const io::Input& input, std::size_t entry, const Json& value, const char* name) {
  if (!value.is_array() || value.size() != 3) fail_at(input, entry, fmt::format("needs [x, y, z] in \"{}\"", name));
  return {number(input, entry, value[0], name), number(input, entry, value[1], name),
          number(input, entry, value[2], name)};
}

SizeRegion region(const io::Input& input, std::size_t entry, const Json& json) {
  if (!json.is_object()) fail_at(input, entry, "is no object such as {\"point\": [0, 0, 0], \"size\": 1}");
  SizeRegion r;
  int shapes = 0;
  for (const auto& [key, value] : json.items()) {
    if (key == "size") {
      r.size = number(input, entry, value, "size");
    } else if (key == "radius") {
      r.radius = number(input, entry, value, "radius");
    } else if (key == "sphere" || key == "point") {
      r.lo = r.hi = point(input, entry, value, key.c_str());
      ++shapes;
    } else if (key == "box") {
      if (!value.is_array() || value.size() != 2) fail_at(input, entry, "needs [[x, y, z], [x, y, z]] in \"box\"");
      const Vec3 a = point(input, entry, value[0], "box"), b = point(input, entry, value[1], "box");
      r.lo = min(a, b);
      r.hi = max(a, b);
      ++shapes;
    } else {
      fail_at(input, entry, fmt::format("has the unknown key {}", io::in_quotes(key)));
    }
  }
  if (shapes != 1) fail_at(input, entry, "needs exactly one of \"box\", \"sphere\" and \"point\"");
  return r;
}

std::vector<SizeRegion> from_json(const io::Input& input) {
  const Json json = Json::parse(input.bytes, nullptr, false);
  if (!json.is_array()) input.fail("is no JSON array of regions; it has to begin with [ and end with ]");
  std::vector<SizeRegion> regions;
  for (const Json& entry : json) regions.push_back(region(input, regions.size(), entry));
  return regions;
}

std::vector<SizeRegion> from_table(const io::Input& input) {
  std::vector<SizeRegion> regions;
  for (const PointSize& s : read_point_table(input)) regions.push_back({s.p, s.p, 0, s.size});
  return regions;
}

}  // namespace

std::vector<SizeRegion> read_size_regions(const std::filesystem::path& file) {
  const io::LoadedFile loaded(file);
  const io::Input& input = loaded.input();
  const std::size_t start = input.bytes.find_first_not_of(" \t\r\n");
  const bool is_json = start != std::string_view::npos && (input.bytes[start] == '[' || input.bytes[start] == '{');
  const std::vector<SizeRegion> regions = is_json ? from_json(input) : from_table(input);
  for (std::size_t i = 0; i < regions.size(); ++i) {
    const SizeRegion& r = regions[i];
    if (!is_finite(r.lo) || !is_finite(r.hi)) fail_at(input, i, "lies at no finite place");
    if (!std::isfinite(r.size) || r.size <= 0)
      fail_at(input, i, fmt::format("has size {}: sizes must be above 0", r.size));
    if (!std::isfinite(r.radius) || r.radius < 0) fail_at(input, i, fmt::format("has radius {}", r.radius));
  }
  return regions;
}

}  // namespace octafront
