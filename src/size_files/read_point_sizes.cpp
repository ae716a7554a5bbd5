// Sizes at points, from tables and from the files of VTK.

#include <octafront/io.h>

#include "io/input.h"
#include "io/vtk_xml.h"
#include "size_files/point_table.h"

#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include <fmt/format.h>

namespace octafront {

namespace {

bool is_separator(char c) {
  return c == ' ' || c == '\t' || c == ',' || c == ';' || c == '\r';
}

/// The four numbers of a line; nothing if it has other content.
std::optional<std::array<double, 4>> four_numbers(std::string_view line) {
  std::array<double, 4> v{};
  const char *at = line.data(), *end = at + line.size();
  for (double& x : v) {
    while (at != end && is_separator(*at)) ++at;
    const auto [next, error] = std::from_chars(at, end, x);
    if (error != std::errc()) return std::nullopt;
    at = next;
  }
  while (at != end && is_separator(*at)) ++at;
  if (at != end) return std::nullopt;
  return v;
}

/// The array "size" of the points, or the only one there is.
const io::VtkArray& size_array(const io::VtkXml& xml, const io::Input& input) {
  if (const io::VtkArray* array = xml.find("PointData", "size")) return *array;
  const io::VtkArray* only = nullptr;
  std::string names;
  for (const io::VtkArray& array : xml.arrays) {
    if (array.section != "PointData") continue;
    only = names.empty() ? &array : nullptr;
    names += (names.empty() ? "" : ", ") + io::in_quotes(array.name);
  }
  if (only != nullptr && only->components == 1) return *only;
  input.fail(names.empty() ? "has no sizes: its <PointData> is empty"
                           : "has no array \"size\" in <PointData>, only " + names);
}

std::vector<PointSize> from_vtk(const io::Input& input) {
  const io::VtkXml xml = io::read_vtk_xml(input, io::VtkKind::kAnyMesh);
  if (xml.points >= kNone) input.fail(fmt::format("holds more than {} points", kNone - 1));
  const io::VtkArray* places = xml.find("Points", "");
  if (places == nullptr) input.fail("has no <Points>");
  const std::vector<double> xyz = io::vtk_reals(xml, *places, input, 3 * xml.points);
  const std::vector<double> size = io::vtk_reals(xml, size_array(xml, input), input, xml.points);
  if (xyz.size() != 3 * size.size()) input.fail("has not as many sizes as points");
  std::vector<PointSize> points;
  points.reserve(size.size());
  for (std::size_t i = 0; i < size.size(); ++i) {
    points.push_back({{xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]}, size[i]});
  }
  return points;
}

}  // namespace

std::vector<PointSize> read_point_table(const io::Input& input) {
  std::vector<PointSize> points;
  std::string_view rest = input.bytes;
  for (bool is_first = true; !rest.empty(); is_first = false) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(rest.size(), line.size() + 1));
    if (line.find_first_not_of(" \t\r") == std::string_view::npos) continue;
    if (const auto v = four_numbers(line)) {
      points.push_back({{(*v)[0], (*v)[1], (*v)[2]}, (*v)[3]});
    } else if (!is_first) {
      input.fail_at_line(line.data(), "is no line of four numbers x, y, z, size");
    }
  }
  return points;
}

std::vector<PointSize> read_point_sizes(const std::filesystem::path& file) {
  const io::LoadedFile loaded(file);
  const io::Input& input = loaded.input();
  const std::size_t start = input.bytes.find_first_not_of(" \t\r\n");
  const bool is_xml = start != std::string_view::npos && input.bytes[start] == '<';
  std::vector<PointSize> points = is_xml ? from_vtk(input) : read_point_table(input);
  if (points.empty()) input.fail("has no points with sizes");
  for (std::size_t i = 0; i < points.size(); ++i) {
    const PointSize& s = points[i];
    if (!is_finite(s.p)) input.fail(fmt::format("point {} lies at no finite place", i));
    if (!std::isfinite(s.size) || s.size <= 0)
      input.fail(fmt::format("point {} has size {}: sizes must be above 0", i, s.size));
  }
  return points;
}

}  // namespace octafront
