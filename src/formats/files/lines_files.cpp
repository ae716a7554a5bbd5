#include <octafront/io.h>

#include "formats/files/formats.h"
#include "formats/read/readers.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>
#include <utility>

#include <fmt/core.h>

namespace octafront {
namespace {

bool is_table(const std::string& file) {
  constexpr std::array<std::string_view, 5> kEndings{".txt", ".csv", ".xyz", ".dat", ".pts"};
  const std::string ending = std::filesystem::path(file).extension().string();
  return std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end();
}

LinesFile lines_of(const io::Input& input) {
  if (is_table(input.name)) return io::read_line_table(input);
  const io::Format& format = io::recognize_surface(input);
  if (format.read_lines != nullptr) return format.read_lines(input);
  if (format.read_mesh == nullptr)
    input.fail(
        "holds no lines or points: give OBJ, PLY, VTK, MSH or another mesh, or a text with a point in each line, "
        "as .txt or .csv");
  io::RawMesh raw = format.read_mesh(input);
  return {std::move(raw.points), std::move(raw.edges), std::move(raw.format), std::move(raw.notes)};
}

}  // namespace

LinesFile read_lines(const std::string& file, const RunContext& context) {
  const io::LoadedFile loaded(file, context);
  LinesFile read = lines_of(loaded.input());
  for (const Edge& e : read.edges)
    for (const VertexIndex v : e)
      if (v >= read.points.size())
        loaded.input().fail(
            fmt::format("a line names the vertex {}, but there are only {}; export it again", v, read.points.size()));
  return read;
}

}  // namespace octafront
