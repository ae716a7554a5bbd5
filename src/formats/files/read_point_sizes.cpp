// Sizes at points, from tables and from the files of VTK.

#include <octafront/io.h>

#include "formats/containers/input.h"
#include "formats/containers/scanner.h"
#include "formats/containers/vtk_xml.h"
#include "formats/files/size_readers.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/core.h>

namespace octafront {

namespace {

/// Four finite numbers, the last one above 0; throws InputError with the line.
PointSize row(const io::Input& input, std::string_view line, const std::vector<std::string_view>& words) {
  if (words.size() != 4)
    input.fail_at_line(line.data(), fmt::format("{} values, not the four x, y, z, size", words.size()));
  std::array<double, 4> v{};
  for (std::size_t k = 0; k < 4; ++k)
    if (!io::parse_number(words[k], v[k]) || !std::isfinite(v[k]))
      input.fail_at_line(line.data(), fmt::format("{} is no finite number", io::in_quotes(words[k])));
  if (v[3] <= 0) input.fail_at_line(line.data(), fmt::format("size {}: sizes must be above 0", v[3]));
  return {{v[0], v[1], v[2]}, v[3]};
}

/// A row with a slip of the finger still has numbers; titles have none.
bool are_titles(const std::vector<std::string_view>& words) {
  return std::none_of(words.begin(), words.end(), [](std::string_view word) {
    double value = 0;
    return io::parse_number(word, value);
  });
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
    const Vec3 p{xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]};
    if (!is_finite(p)) input.fail(fmt::format("point {} lies at no finite place", i));
    if (!std::isfinite(size[i]) || size[i] <= 0)
      input.fail(fmt::format("point {} has size {}: sizes must be above 0", i, size[i]));
    points.push_back({p, size[i]});
  }
  if (points.empty()) input.fail("has no points with sizes");
  return points;
}

}  // namespace

std::vector<PointSize> read_point_table(const io::Input& input) {
  std::vector<PointSize> points;
  std::string_view rest = input.bytes;
  io::ReadingProgress progress(input);
  for (bool is_first = true; !rest.empty();) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    progress.reach(line.data());
    rest.remove_prefix(std::min(rest.size(), line.size() + 1));
    const std::vector<std::string_view> words = io::table_words(line);
    if (words.empty()) continue;
    if (!is_first || !are_titles(words)) points.push_back(row(input, line, words));
    is_first = false;
  }
  if (points.empty()) input.fail("has no line of four numbers x, y, z, size");
  return points;
}

std::vector<PointSize> read_point_sizes_bytes(const io::Input& input) {
  const std::size_t start = input.bytes.find_first_not_of(" \t\r\n");
  const bool is_xml = start != std::string_view::npos && input.bytes[start] == '<';
  return is_xml ? from_vtk(input) : read_point_table(input);
}

std::vector<PointSize> read_point_sizes(const std::string& file, const RunContext& context) {
  return read_point_sizes_bytes(io::LoadedFile(file, context).input());
}

}  // namespace octafront
