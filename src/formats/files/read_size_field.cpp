// Reads back what write_size_field() writes, edited or not.

#include <octafront/error.h>

#include "base/core/elementary.h"
#include "formats/containers/vtk_xml.h"
#include "formats/files/size_readers.h"
#include "sizing/field/gradation.h"
#include "sizing/field/octree_corners.h"
#include "sizing/field/octree_field.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

namespace octafront {

namespace {

/// Corners of a hexahedron as VTK orders them that bound its diagonal.
constexpr std::size_t kLowCorner = 0, kHighCorner = 6;

/// The cells of a file, as the grid that they form has them.
struct GridFile {
  std::vector<Vec3> points;
  std::vector<double> size;
  std::vector<std::int64_t> corners;  ///< eight per cell
};

const io::VtkArray& require(const io::VtkXml& xml, const io::Input& input, const char* section, const char* name) {
  const io::VtkArray* array = xml.find(section, name);
  if (array == nullptr)
    input.fail(
        fmt::format("has no array {} in <{}>: it is no background grid; sizes at points are given by `point_sizes`",
                    io::in_quotes(name), section));
  return *array;
}

GridFile read_grid_file(const io::Input& input) {
  const io::VtkXml xml = io::read_vtk_xml(input);
  if (std::max(xml.points, xml.cells) >= kNone)
    input.fail(fmt::format("holds more than {} points or cells", kNone - 1));
  const std::vector<double> xyz = io::vtk_reals(xml, require(xml, input, "Points", ""), input, 3 * xml.points);
  GridFile grid;
  grid.size = io::vtk_reals(xml, require(xml, input, "PointData", "size"), input, xml.points);
  grid.corners = io::vtk_integers(xml, require(xml, input, "Cells", "connectivity"), input, 8 * xml.cells);
  if (xyz.size() != 3 * grid.size.size()) input.fail("has not as many sizes as points");
  for (std::size_t i = 0; i < xyz.size(); i += 3) {
    grid.points.push_back({xyz[i], xyz[i + 1], xyz[i + 2]});
    if (!is_finite(grid.points.back())) input.fail(fmt::format("point {} lies at no finite place", i / 3));
  }
  if (grid.corners.empty() || grid.corners.size() % 8 != 0) input.fail("has cells that are no hexahedra");
  for (const std::int64_t c : grid.corners) {
    if (c < 0 || static_cast<std::size_t>(c) >= grid.points.size()) input.fail("names a point that it does not have");
  }
  for (const double h : grid.size) {
    if (!std::isfinite(h) || h <= 0) input.fail(fmt::format("has size {}: sizes must be above 0", h));
  }
  return grid;
}

RootCube root_of(const io::Input& input, const GridFile& grid) {
  Box3 box;
  for (const Vec3 p : grid.points) box.add(p);
  const Vec3 e = box.extent();
  const double side = std::max({e.x, e.y, e.z});
  if (!(std::min({e.x, e.y, e.z}) > 0.999 * side)) input.fail("covers no cube: it is no background grid");
  return {box.lo, side};
}

/// The tree whose leaves the cells are.
Octree tree_of(const io::Input& input, const GridFile& grid, const RootCube& root) {
  std::vector<OctreeKey> leaves;
  for (std::size_t c = 0; c < grid.corners.size(); c += 8) {
    const Vec3 lo = grid.points[grid.corners[c + kLowCorner]], hi = grid.points[grid.corners[c + kHighCorner]];
    const double level = std::round(elementary::log2(root.side / (hi.x - lo.x)));
    if (!(level >= 0 && level <= OctreeKey::kMaxLevel)) input.fail(fmt::format("cell {} is no octree cell", c / 8));
    leaves.push_back(root.cell(0.5 * (lo + hi)).ancestor(static_cast<int>(level)));
  }
  std::sort(leaves.begin(), leaves.end());
  if (!cover_the_root(leaves)) input.fail("has cells that do not cover its cube once");
  Octree tree(std::move(leaves));
  if (!tree.is_balanced()) input.fail("has neighbouring cells that differ by more than a factor of two");
  return tree;
}

/// The sizes of the file at the corners, found by their places.
std::vector<double> corner_sizes(const GridFile& grid, const RootCube& root, const OctreeCorners& corners) {
  using Place = std::array<std::uint32_t, 3>;
  std::vector<std::pair<Place, double>> sizes;
  for (std::size_t i = 0; i < grid.points.size(); ++i) {
    const Vec3 u = (grid.points[i] - root.lo) / root.unit();
    const auto unit = [](double x) { return static_cast<std::uint32_t>(std::llround(std::max(0.0, x))); };
    sizes.push_back({{unit(u.x), unit(u.y), unit(u.z)}, grid.size[i]});
  }
  std::sort(sizes.begin(), sizes.end());
  std::vector<double> caps(corners.size(), HUGE_VAL);
  for (std::size_t c = 0; c < corners.size(); ++c) {
    const auto it = std::lower_bound(sizes.begin(), sizes.end(), std::pair<Place, double>{corners.position[c], 0});
    if (it != sizes.end() && it->first == corners.position[c]) caps[c] = it->second / root.side;
  }
  // What is asked at a hanging corner binds the corners that it hangs between.
  for (std::uint32_t c = 0; c < corners.size(); ++c) {
    double mean = 0;
    for (const auto& s : corners.shares_of(c)) mean += s.weight * caps[s.corner];
    if (!(mean > caps[c] * (1 + 1e-9))) continue;
    for (const auto& s : corners.shares_of(c)) caps[s.corner] = std::min(caps[s.corner], caps[c]);
  }
  return caps;
}

}  // namespace

SizeField read_size_field_bytes(const io::Input& input, double gradation) {
  const GridFile grid = read_grid_file(input);
  const RootCube root = root_of(input, grid);
  const Octree tree = tree_of(input, grid, root);
  const OctreeCorners corners = octree_corners(tree);
  const double ceiling = *std::max_element(grid.size.begin(), grid.size.end()) / root.side;
  return SizeFunction::field(
      graded_field(root, tree, corners, corner_sizes(grid, root, corners), gradation, ceiling, input.context));
}

SizeField read_size_field(const std::string& file, double gradation, const RunContext& context) {
  if (!(gradation >= 0.01 && gradation <= 1)) {
    throw OptionError(fmt::format("`gradation` is {}: it must lie between 0.01 (slow growth) and 1 (fast)", gradation));
  }
  return read_size_field_bytes(io::LoadedFile(file, context).input(), gradation);
}

}  // namespace octafront
