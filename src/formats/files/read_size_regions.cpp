#include <octafront/io.h>

#include "formats/containers/input.h"
#include "formats/files/size_readers.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include <fmt/core.h>

namespace octafront {

namespace {

using Json = nlohmann::json;

[[noreturn]] void fail_at_region(const io::Input& input, std::size_t entry, const std::string& reason) {
  input.fail(fmt::format("entry {} {}", entry, reason));
}

double number(const io::Input& input, std::size_t entry, const Json& value, const char* name) {
  if (!value.is_number()) fail_at_region(input, entry, fmt::format("needs a number for \"{}\"", name));
  return value.get<double>();
}

Vec3 point(const io::Input& input, std::size_t entry, const Json& value, const char* name) {
  if (!value.is_array() || value.size() != 3)
    fail_at_region(input, entry, fmt::format("needs [x, y, z] in \"{}\"", name));
  return {number(input, entry, value[0], name), number(input, entry, value[1], name),
          number(input, entry, value[2], name)};
}

void read_box(const io::Input& input, std::size_t entry, const Json& value, SizeRegion& r) {
  if (!value.is_array() || value.size() != 2) fail_at_region(input, entry, "needs [[x, y, z], [x, y, z]] in \"box\"");
  r.lo = point(input, entry, value[0], "box");
  r.hi = point(input, entry, value[1], "box");
  if (r.lo != min(r.lo, r.hi))
    fail_at_region(input, entry, "has a \"box\" with corners swapped: first its least x, y and z, then its largest");
}

void check(const io::Input& input, std::size_t entry, const Json& json, const SizeRegion& r) {
  if (json.contains("box") + json.contains("sphere") + json.contains("point") != 1)
    fail_at_region(input, entry, "needs exactly one of \"box\", \"sphere\" and \"point\"");
  if (!json.contains("size")) fail_at_region(input, entry, "has no \"size\"");
  if (r.size <= 0) fail_at_region(input, entry, fmt::format("has size {}: sizes must be above 0", r.size));
  if (r.radius < 0) fail_at_region(input, entry, fmt::format("has radius {}", r.radius));
  if (json.contains("sphere") && r.radius == 0)
    fail_at_region(input, entry, "is a sphere and needs a \"radius\" above 0; a place without extent is a \"point\"");
}

SizeRegion region(const io::Input& input, std::size_t entry, const Json& json) {
  if (!json.is_object()) fail_at_region(input, entry, "is no object such as {\"point\": [0, 0, 0], \"size\": 1}");
  SizeRegion r;
  for (const auto& [key, value] : json.items()) {
    if (key == "size") {
      r.size = number(input, entry, value, "size");
    } else if (key == "radius") {
      r.radius = number(input, entry, value, "radius");
    } else if (key == "sphere" || key == "point") {
      r.lo = r.hi = point(input, entry, value, key.c_str());
    } else if (key == "box") {
      read_box(input, entry, value, r);
    } else {
      fail_at_region(input, entry, fmt::format("has the unknown key {}", io::in_quotes(key)));
    }
  }
  check(input, entry, json, r);
  return r;
}

Json parsed(const io::Input& input) {
  try {
    return Json::parse(input.bytes);
  } catch (const Json::parse_error& error) {
    input.fail_at_line(input.bytes.data() + std::min(error.byte, input.bytes.size()), "is no JSON from here on");
  } catch (const Json::out_of_range& error) {
    input.fail("holds a number that no computer number is: write it shorter");
  }
}

std::vector<SizeRegion> from_json(const io::Input& input) {
  const Json json = parsed(input);
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

std::vector<SizeRegion> read_size_regions_bytes(const io::Input& input) {
  const std::size_t start = input.bytes.find_first_not_of(" \t\r\n");
  const bool is_json = start != std::string_view::npos && (input.bytes[start] == '[' || input.bytes[start] == '{');
  return is_json ? from_json(input) : from_table(input);
}

std::vector<SizeRegion> read_size_regions(const std::string& file, const RunContext& context) {
  return read_size_regions_bytes(io::LoadedFile(file, context).input());
}

}  // namespace octafront
