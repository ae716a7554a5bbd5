// The background grid as a VTK unstructured grid: a hexahedron for each leaf, `size` at the points, `level` per cell.

#include <octafront/error.h>
#include <octafront/io.h>

#include "formats/write/vtu_head.h"
#include "sizing/field/octree_corners.h"
#include "sizing/field/octree_field.h"

#include <fmt/core.h>

namespace octafront {

namespace {

constexpr std::uint8_t kVtkHexahedron = 12;
/// VTK runs around the bottom and the top of a hexahedron; our corners count in binary.
constexpr std::array<int, 8> kCornerOfVtk{0, 1, 3, 2, 4, 5, 7, 6};

std::vector<double> sizes_at_corners(const OctreeField& field, const OctreeCorners& corners) {
  std::vector<double> size(corners.size());
  for (std::size_t l = 0; l < field.tree.size(); ++l) {
    for (int k = 0; k < 8; ++k) size[corners.of_leaf[l][k]] = field.h[l][k] * field.root.side;
  }
  return size;
}

void write_grid(io::AtomicFile& file, const OctreeField& field) {
  const OctreeCorners corners = octree_corners(field.tree);
  const std::vector<double> size = sizes_at_corners(field, corners);
  const std::uint64_t points = corners.size(), cells = field.tree.size();
  io::TextWriter out(file);
  io::VtuArrays arrays(file);
  io::begin_grid(out);
  io::begin_piece(out, points, cells);
  out << "      <Points>\n";
  arrays.declare<double>("Float64", "Points", 3, 3 * points, [&](std::uint64_t i) {
    return field.root.position(corners.position[i / 3])[static_cast<int>(i % 3)];
  });
  out << "      </Points>\n      <Cells>\n";
  arrays.declare<std::int64_t>("Int64", "connectivity", 1, 8 * cells, [&](std::uint64_t i) {
    return static_cast<std::int64_t>(corners.of_leaf[i / 8][kCornerOfVtk[i % 8]]);
  });
  arrays.declare<std::int64_t>("Int64", "offsets", 1, cells,
                               [](std::uint64_t i) { return static_cast<std::int64_t>(8 * (i + 1)); });
  arrays.declare<std::uint8_t>("UInt8", "types", 1, cells, [](std::uint64_t) { return kVtkHexahedron; });
  out << "      </Cells>\n      <PointData Scalars=\"size\">\n";
  arrays.declare<double>("Float64", "size", 1, points, [&](std::uint64_t i) { return size[i]; });
  out << "      </PointData>\n      <CellData>\n";
  arrays.declare<std::int32_t>("Int32", "level", 1, cells,
                               [&](std::uint64_t i) { return static_cast<std::int32_t>(field.tree.leaf(i).level()); });
  out << "      </CellData>\n";
  io::end_vtu(out, arrays);
}

}  // namespace

void check_size_field_target(const std::string& file) {
  const std::string ending = std::filesystem::path(file).extension().string();
  if (ending != ".vtu")
    throw OptionError(fmt::format("{}: the background grid is written as .vtu, not as \"{}\"", file, ending));
  io::check_writable(file);
}

void write_size_field(const std::string& file, const SizeField& sizes, const RunContext& context) {
  const OctreeField* grid = as_octree_field(sizes);
  if (grid == nullptr) throw OutputError("these sizes have no background grid that could be written to " + file);
  io::AtomicFile out(file, context);
  write_grid(out, *grid);
  out.commit();
}

}  // namespace octafront
