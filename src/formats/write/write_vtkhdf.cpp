// VTKHDF 1.0, VTK's unstructured grids in HDF5: the cells and data of formats/parts/vtk_cells.h and beta, and of a mesh
// in parts those of formats/write/vtk_pieces.h. One file holds all parts, one behind the other; the whole mesh is one
// part, so that its bytes hang on nothing but the mesh.

#include <octafront/quality.h>

#include "formats/containers/hdf5_file.h"
#include "formats/write/vtk_pieces.h"
#include "formats/write/writers.h"

#include <map>
#include <set>
#include <string>
#include <vector>

#include <fmt/core.h>

namespace octafront::io {
namespace {

const std::string kRoot = "/VTKHDF";

struct Sizes {
  std::uint64_t points = 0, cells = 0, nodes = 0;
};

/// Names of links in a group; their paths know no slash.
class LinkNames {
 public:
  const std::string& of(const std::string& name) {
    const auto [at, is_new] = links_.try_emplace(name);
    if (!is_new) return at->second;
    std::string link = name;
    std::replace(link.begin(), link.end(), '/', '_');
    if (link == "." || link.empty()) link.assign(1, '_');
    std::string free = link;
    for (int n = 2; !taken_.insert(free).second; ++n) free = fmt::format("{}_{}", link, n);
    return at->second = free;
  }

 private:
  std::map<std::string, std::string> links_;
  std::set<std::string> taken_;
};

class VtkHdfWriter {
 public:
  VtkHdfWriter(MeshOutput& out, const VtkCells::Names& names, std::vector<Sizes> sizes)
      : file_(out.path_for_library(), out.target().string(), out.context()), sizes_(std::move(sizes)) {
    constexpr std::string_view kType = "UnstructuredGrid";
    file_.group(kRoot);
    file_.attribute(kRoot, "Version", std::vector<std::int32_t>{1, 0});
    file_.attribute(kRoot, "Type", kType, kType.size());
    for (const char* group : {"/PointData", "/CellData", "/FieldData"}) file_.group(kRoot + group);
    per_part("NumberOfPoints", [](const Sizes& s) { return s.points; });
    per_part("NumberOfCells", [](const Sizes& s) { return s.cells; });
    per_part("NumberOfConnectivityIds", [](const Sizes& s) { return s.nodes; });
    LinkNames links;
    for (const auto& [name, number] : names)
      file_.values<std::int32_t>(kRoot + "/FieldData/" + links.of(name), {1},
                                 [n = static_cast<std::int32_t>(number)](std::uint64_t) { return n; });
    for (const Sizes& s : sizes_) {
      all_.points += s.points;
      all_.cells += s.cells;
      all_.nodes += s.nodes;
    }
  }

  /// The next part; `piece` is null if it is the whole mesh.
  void write(const MeshParts& mesh, std::span<const MeshField> fields, const VtkPiece* piece) {
    const VtkCells cells(mesh, piece == nullptr ? VtkCells::Shown::of(mesh) : piece->whole.shown);
    const Sizes& own = sizes_[part_];
    rows<double>("/Points", {all_.points, 3}, {before_.points, own.points},
                 [&](std::uint64_t i) { return mesh.mesh().points[i / 3][static_cast<int>(i % 3)]; });
    rows<std::int64_t>("/Connectivity", {all_.nodes}, {before_.nodes, own.nodes},
                       [&](std::uint64_t i) { return std::int64_t{cells.node(i)}; });
    rows<std::int64_t>("/Offsets", {all_.cells + sizes_.size()}, {before_.cells + part_, own.cells + 1},
                       [&](std::uint64_t i) { return i == 0 ? 0 : static_cast<std::int64_t>(cells.end_of(i - 1)); });
    rows<std::uint8_t>("/Types", {all_.cells}, {before_.cells, own.cells},
                       [&](std::uint64_t c) { return cells.type(c); });
    if (piece != nullptr) write_place(*piece, cells);
    write_data(cells, fields);
    of_cells<float>("beta", [&](std::uint64_t c) {
      const TetIndex t = cells.tet_of(c);
      if (t == kNone) return 0.0F;
      const auto& [a, b, d, e] = mesh.mesh().tets[t];
      const auto& p = mesh.mesh().points;
      return static_cast<float>(radius_ratio(p[a], p[b], p[d], p[e]));
    });
    before_.points += own.points;
    before_.cells += own.cells;
    before_.nodes += own.nodes;
    ++part_;
  }

  void close() { file_.close(); }

 private:
  template <class SizeOf>
  void per_part(const std::string& name, const SizeOf& size_of) {
    file_.values<std::int64_t>(kRoot + "/" + name, {sizes_.size()},
                               [&](std::uint64_t k) { return static_cast<std::int64_t>(size_of(sizes_[k])); });
  }

  template <class T, class ValueAt>
  void rows(const std::string& path, const std::vector<std::uint64_t>& shape, Hdf5Writer::Stretch stretch,
            const ValueAt& value_at) {
    file_.rows(kRoot + path, shape, stretch, Hdf5Writer::each<T>(value_at));
  }
  template <class T, class ValueAt>
  void of_points(const std::string& name, const ValueAt& value_at, std::uint64_t components = 1) {
    array<T>("/PointData/" + point_names_.of(name), all_.points, {before_.points, sizes_[part_].points}, components,
             value_at);
  }
  template <class T, class ValueAt>
  void of_cells(const std::string& name, const ValueAt& value_at, std::uint64_t components = 1) {
    array<T>("/CellData/" + cell_names_.of(name), all_.cells, {before_.cells, sizes_[part_].cells}, components,
             value_at);
  }
  template <class T, class ValueAt>
  void array(const std::string& path, std::uint64_t count, Hdf5Writer::Stretch stretch, std::uint64_t components,
             const ValueAt& value_at) {
    std::vector<std::uint64_t> shape{count};
    if (components > 1) shape.push_back(components);
    rows<T>(path, shape, stretch, value_at);
  }

  void write_place(const VtkPiece& piece, const VtkCells& cells) {
    const std::string ghost(kGhostType);
    of_points<std::uint8_t>(ghost, [&](std::uint64_t v) { return piece.ghost_type_of_point(v); });
    of_points<std::int64_t>("GlobalPointIds", [&](std::uint64_t v) { return piece.id_of_point(v); });
    of_cells<std::uint8_t>(ghost, [&](std::uint64_t c) { return piece.ghost_type_of_cell(cells, c); });
    of_cells<std::int64_t>("GlobalCellIds", [&](std::uint64_t c) { return piece.id_of_cell(cells, c); });
    of_cells<std::int32_t>("part",
                           [&](std::uint64_t c) { return static_cast<std::int32_t>(piece.part_of_cell(cells, c)); });
  }

  void write_data(const VtkCells& cells, std::span<const MeshField> fields) {
    for (std::size_t d = 0; d < cells.data().size(); ++d) {
      const VtkCells::Data& data = cells.data()[d];
      const auto number = [&](std::uint64_t i) { return cells.value(d, i); };
      const auto flag = [&](std::uint64_t i) { return static_cast<std::uint8_t>(cells.value(d, i)); };
      if (data.of_points)
        of_points<std::uint8_t>(data.name, flag);
      else if (data.is_set)
        of_cells<std::uint8_t>(data.name, flag);
      else
        of_cells<std::int32_t>(data.name, number);
    }
    for (const MeshField& field : fields) {
      const std::uint64_t n = field.components;
      const auto value = [&](std::uint64_t i) { return cells.value_of(field, i / n, i % n); };
      if (field.of_elements)
        of_cells<double>(field.name, value, n);
      else
        of_points<double>(field.name, value, n);
    }
  }

  Hdf5Writer file_;
  std::vector<Sizes> sizes_;
  Sizes all_, before_;
  std::size_t part_ = 0;
  LinkNames point_names_, cell_names_;
};

Sizes sizes_of(const MeshParts& mesh, const VtkCells::Shown& shown) {
  const VtkCells cells(mesh, shown);
  return {mesh.points(), cells.size(), cells.nodes()};
}

}  // namespace

void write_vtkhdf(MeshOutput& out, const MeshParts& mesh) {
  VtkHdfWriter writer(out, VtkCells::names_of(mesh), {sizes_of(mesh, VtkCells::Shown::of(mesh))});
  writer.write(mesh, out.fields(), nullptr);
  writer.close();
}

void write_vtkhdf_parts(MeshOutput& out, Pieces& pieces) {
  const VtkWhole whole = VtkWhole::of(pieces);
  std::vector<Sizes> sizes;
  for (std::uint32_t k = 0; k < pieces.count(); ++k) {
    const Piece piece = pieces.piece(k);
    sizes.push_back(sizes_of(VtkPiece(piece, whole).mesh, whole.shown));
  }
  VtkHdfWriter writer(out, whole.names, std::move(sizes));
  for (std::uint32_t k = 0; k < pieces.count(); ++k) {
    const Piece piece = pieces.piece(k);
    const VtkPiece in_whole(piece, whole);
    writer.write(in_whole.mesh, piece.fields, &in_whole);
  }
  writer.close();
}

}  // namespace octafront::io
