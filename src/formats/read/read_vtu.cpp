// VTK unstructured grids: ours (see vtk_cells.h), and those of other programs as far as they hold tetrahedra.

#include "formats/containers/vtk_xml.h"
#include "formats/parts/raw_mesh.h"
#include "formats/read/readers.h"
#include "formats/read/vtk_reading.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <utility>

#include <fmt/core.h>

namespace octafront::io {
namespace {

constexpr std::uint64_t kMostCells = std::uint64_t{1} << 40;

class Vtu {
 public:
  explicit Vtu(const Input& input) : input_(input), xml_(read_vtk_xml(input)) {}

  RawMesh read() {
    read_points();
    input_.context.check();
    read_cells();
    read_names();
    raw_.format = "VTU";
    return std::move(raw_);
  }

 private:
  const VtkArray& require(std::string_view section, std::string_view name) const {
    const VtkArray* array = xml_.find(section, name);
    if (array == nullptr)
      input_.fail(fmt::format("has no array {} in <{}>; the file is damaged: export it again",
                              name.empty() ? "of values" : in_quotes(name), section));
    return *array;
  }

  void check_length(const VtkArray& array, std::uint64_t length, std::uint64_t wanted) const {
    if (length != wanted)
      input_.fail_at_line(array.at, fmt::format("{} has {} values, not {}; the file is damaged: export it again",
                                                array.label(), length, wanted));
  }

  void read_points() {
    const VtkArray& array = require("Points", "");
    if (xml_.points >= kNone) input_.fail(fmt::format("holds more than {} points", kNone - 1));
    const std::vector<double> xyz = vtk_reals(xml_, array, input_, 3 * xml_.points);
    // Compared by division: the product may overflow.
    if (xyz.size() % 3 != 0 || xyz.size() / 3 != xml_.points)
      input_.fail_at_line(array.at, fmt::format("{} has {} values, not 3 for each of {} points; the file is damaged: "
                                                "export it again",
                                                array.label(), xyz.size(), xml_.points));
    raw_.points.reserve(xml_.points);
    for (std::size_t i = 0; i < xyz.size(); i += 3) {
      const Vec3 p{xyz[i], xyz[i + 1], xyz[i + 2]};
      if (!is_finite(p))
        input_.fail_at_line(array.at, fmt::format("point {} is ({}, {}, {}), which is no place", i / 3, p.x, p.y, p.z));
      raw_.points.push_back(p);
    }
  }

  /// The values of a cell array, if there is one; `shift` turns numbers from 0 into references from 1.
  std::optional<std::vector<std::int64_t>> cell_integers(std::string_view name, std::int64_t shift) const {
    const VtkArray* array = xml_.find("CellData", name);
    if (array == nullptr || array->components != 1 || array->type.starts_with("Float")) return std::nullopt;
    std::vector<std::int64_t> values = vtk_integers(xml_, *array, input_, xml_.cells);
    check_length(*array, values.size(), xml_.cells);
    constexpr std::int64_t kMost = std::int64_t{1} << 62;
    for (std::int64_t& v : values) v = v < kMost ? v + shift : kMost;
    return values;
  }

  /// Ours, or what meshio makes of Gmsh's and MEDIT's references.
  std::vector<std::int64_t> references(std::string_view ours) const {
    if (auto values = cell_integers(ours, 1)) return *std::move(values);
    if (auto values = cell_integers("gmsh:physical", 0)) return *std::move(values);
    if (auto values = cell_integers("medit:ref", 0)) return *std::move(values);
    return {};
  }

  static bool is_solid(std::int64_t type) {
    constexpr std::array<std::int64_t, 10> kSolids{10, 11, 12, 13, 14, 24, 25, 26, 27, 29};
    return std::find(kSolids.begin(), kSolids.end(), type) != kSolids.end();
  }

  /// Arrays of other programs.
  std::vector<CellNumbers> other_numbers() const {
    std::vector<CellNumbers> arrays;
    for (const VtkArray& array : xml_.arrays) {
      const bool is_known = is_numbering(array.name) || array.name == "beta" || array.name.starts_with("vtkGhost");
      if (array.section != "CellData" || is_known) continue;
      if (auto values = cell_integers(array.name, 0)) arrays.push_back({array.name, *std::move(values)});
    }
    return arrays;
  }

  /// Of all cells together: more than any mesh has, polyhedra, lines through all points and high orders included.
  std::uint64_t most_corners() const { return 64 * std::min(xml_.cells, kMostCells) + 4 * xml_.points; }

  void read_cells() {
    const VtkArray &connectivity_array = require("Cells", "connectivity"), &offsets_array = require("Cells", "offsets"),
                   &types_array = require("Cells", "types");
    const std::vector<std::int64_t> types = vtk_integers(xml_, types_array, input_, xml_.cells);
    check_length(types_array, types.size(), xml_.cells);
    const std::vector<std::int64_t> offsets = vtk_integers(xml_, offsets_array, input_, xml_.cells);
    check_length(offsets_array, offsets.size(), xml_.cells);
    const std::vector<std::int64_t> connectivity = vtk_integers(xml_, connectivity_array, input_, most_corners());
    VtkCellData data{references("region"), references("patch"), references("curve"), {}, {}, {}};
    if (data.region.empty() && data.patch.empty()) data.region = data.patch = material_of(other_numbers(), raw_.notes);
    if (const auto labels = cell_integers("label", 0); labels && xml_.find("CellData", "region"))
      for (std::size_t c = 0; c < types.size(); ++c)
        if (is_solid(types[c]) && c < data.region.size()) raw_.region_labels[data.region[c]] = (*labels)[c];
    if (auto sources = cell_integers("source", 0)) data.source = *std::move(sources);
    if (auto layers = cell_integers("layers", 0)) data.layers = *std::move(layers);
    for (const VtkArray& array : xml_.arrays)
      if (array.section == "CellData" && is_set_name(array.name))
        if (auto values = cell_integers(array.name, 0)) data.sets.emplace_back(array.name, *std::move(values));
    data.field = field_of("CellData", xml_.cells);
    data.field_components = raw_.field.components;
    raw_.field.at_points = field_of("PointData", xml_.points);
    VtkCellTaker taker(input_, raw_, data);
    std::int64_t begin = 0;
    for (std::uint64_t c = 0; c < xml_.cells; ++c) {
      const std::int64_t end = offsets[c];
      if (end < begin || static_cast<std::uint64_t>(end) > connectivity.size())
        input_.fail_at_line(offsets_array.at, fmt::format("cell {} has corners {} to {} of {}; the file is damaged: "
                                                          "export it again",
                                                          c, begin, end, connectivity.size()));
      taker.take(
          c, types[c],
          std::span(connectivity).subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin)));
      begin = end;
    }
    taker.finish();
    read_point_sets();
  }

  /// The values that Input::field asks for, if they are in that section.
  std::vector<double> field_of(std::string_view section, std::uint64_t count) {
    std::vector<double> values;
    for (const VtkArray& array : xml_.arrays) {
      if (array.section != section || is_numbering(array.name) || !array.type.starts_with("Float")) continue;
      if (array.components != 1 && section != "PointData" && !input_.wants_element_tensors) continue;
      const auto components = static_cast<std::uint64_t>(array.components);
      if (!raw_.field.offer(input_, array.name, components)) continue;
      values = vtk_reals(xml_, array, input_, components * count);
      check_length(array, values.size(), components * count);
    }
    return values;
  }

  void read_point_sets() {
    for (const VtkArray& array : xml_.arrays) {
      if (array.section != "PointData" || !is_set_name(array.name) || array.components != 1) continue;
      if (array.type.starts_with("Float")) continue;
      const std::vector<std::int64_t> values = vtk_integers(xml_, array, input_, xml_.points);
      check_length(array, values.size(), xml_.points);
      add_node_set(raw_, array.name, values);
    }
  }

  void read_names() {
    constexpr std::uint64_t kMostFieldValues = 1024;  // ours have one
    for (const VtkArray& array : xml_.arrays) {
      if (array.section != "FieldData" || array.type.starts_with("Float")) continue;
      const std::vector<std::int64_t> number = vtk_integers(xml_, array, input_, kMostFieldValues);
      if (number.size() == 1) add_vtk_name(raw_, array.name, number[0]);
    }
  }

  const Input& input_;
  VtkXml xml_;
  RawMesh raw_;
};

}  // namespace

Told told_vtu(const FileHead& head) {
  return head.kind.find("unstructured grid") != std::string_view::npos ? Told::kMagic : Told::kNot;
}

RawMesh read_vtu(const Input& input) {
  return Vtu(input).read();
}

}  // namespace octafront::io
