// XDMF 3: the first grid with tetrahedra, of one type of element or mixed; values in HDF5 or as text. Faces and edges
// come from further grids and from NAME_patches.xdmf and NAME_curves.xdmf, as write_xdmf.cpp leaves them; numbers are
// the attributes "region", "patch", "curve", or those of meshio's and FEniCSx's names.

#include "formats/containers/hdf5_file.h"
#include "formats/containers/named_file.h"
#include "formats/containers/scanner.h"
#include "formats/containers/vtk_xml.h"
#include "formats/parts/raw_mesh.h"
#include "formats/read/readers.h"
#include "formats/read/vtk_reading.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>

#include <fmt/core.h>

namespace octafront::io {
namespace {

namespace fs = std::filesystem;

/// A DataItem: text, or a place in an HDF5 file.
struct Item {
  bool is_text = false;
  std::string_view text;
  const char* at = nullptr;
};
struct Attribute {
  std::string name;
  bool of_nodes = false;
  Item item;
};
struct ReadGrid {
  std::string topology;
  std::uint64_t nodes_per_element = 0;
  std::optional<Item> cells, points;
  std::vector<Attribute> attributes;
  std::vector<std::pair<std::string, std::string>> names;  ///< "patch 3" and its name
};

/// XDMF's types: name in lower case, number in mixed lists, VTK's type, nodes.
struct XdmfCell {
  std::string_view name;
  std::int64_t number;
  std::int64_t vtk;
  std::size_t nodes;
};
constexpr std::array kXdmfCells{XdmfCell{"tetrahedron", 6, 10, 4},
                                XdmfCell{"tetrahedron_10", 38, 24, 10},
                                XdmfCell{"tet_10", 38, 24, 10},
                                XdmfCell{"triangle", 4, 5, 3},
                                XdmfCell{"triangle_6", 36, 22, 6},
                                XdmfCell{"tri_6", 36, 22, 6},
                                XdmfCell{"polyline", 2, 3, 2},
                                XdmfCell{"edge_3", 34, 21, 3},
                                XdmfCell{"quadrilateral", 5, 9, 4},
                                XdmfCell{"pyramid", 7, 14, 5},
                                XdmfCell{"wedge", 8, 13, 6},
                                XdmfCell{"hexahedron", 9, 12, 8},
                                XdmfCell{"quadrilateral_8", 37, 23, 8},
                                XdmfCell{"pyramid_13", 39, 27, 13},
                                XdmfCell{"wedge_15", 40, 26, 15},
                                XdmfCell{"hexahedron_20", 48, 25, 20},
                                XdmfCell{"polyvertex", 1, 1, 1}};

/// The grids of one file.
class XdmfFile {
 public:
  explicit XdmfFile(const Input& input) : input_(input), tags_(input) {}

  std::vector<ReadGrid> grids() {
    bool ended = false;
    for (XmlTag tag = tags_.next(); !tag.name.empty(); tag = tags_.next()) {
      if (tag.closes) {
        ended = ended || tag.name == "Xdmf";
        leave(tag.name);
      } else {
        enter(tag);
        if (tag.empty) leave(tag.name);
      }
    }
    if (!ended) input_.fail("ends without </Xdmf>; it is truncated: copy or export it again");
    return std::move(grids_);
  }

  std::vector<double> reals(const Item& item, std::uint64_t) {
    if (!item.is_text) return at(item).first->reals(at(item).second);
    std::vector<double> all;
    for_each_word(item, [&](Scanner& scan) { all.push_back(scan.number("a number")); });
    return all;
  }
  std::vector<std::int64_t> integers(const Item& item) {
    if (!item.is_text) return at(item).first->integers(at(item).second);
    std::vector<std::int64_t> all;
    for_each_word(item, [&](Scanner& scan) { all.push_back(scan.integer("a whole number")); });
    return all;
  }

 private:
  void enter(const XmlTag& tag) {
    if (tag.name == "Grid" && tag.attribute("GridType", "Uniform") != "Collection" &&
        tag.attribute("GridType", "Uniform") != "Tree")
      grids_.emplace_back();
    if (grids_.empty()) return;
    ReadGrid& grid = grids_.back();
    if (tag.name == "Topology") {
      within_ = tag.name;
      for (const char c : tag.attribute("TopologyType", tag.attribute("Type"))) grid.topology += to_lower(c);
      const std::string_view nodes = tag.attribute("NodesPerElement");
      std::from_chars(nodes.data(), nodes.data() + nodes.size(), grid.nodes_per_element);
    } else if (tag.name == "Geometry") {
      within_ = tag.name;
    } else if (tag.name == "Attribute") {
      within_ = tag.name;
      grid.attributes.push_back({unescaped(tag.attribute("Name")), tag.attribute("Center") == "Node", {}});
      constexpr std::string_view kName = "name_";
      for (const auto& [key, value] : tag.attributes)
        if (key.starts_with(kName))
          grid.names.emplace_back(grid.attributes.back().name + " " + std::string(key.substr(kName.size())),
                                  unescaped(value));
    } else if (tag.name == "DataItem" && !tag.empty) {
      take_item(tag, grid);
    }
  }

  void leave(std::string_view name) {
    if (name == within_) within_ = {};
  }

  void take_item(const XmlTag& tag, ReadGrid& grid) {
    const std::size_t begin = static_cast<std::size_t>(tag.behind - input_.bytes.data());
    const std::size_t end = std::min(input_.bytes.find('<', begin), input_.bytes.size());
    const std::string_view format = tag.attribute("Format", "XML");
    if (format != "XML" && format != "HDF")
      input_.fail_at_line(tag.at, fmt::format("values as {} are not read here; HDF and XML are", in_quotes(format)));
    const Item item{format == "XML", input_.bytes.substr(begin, end - begin), tag.at};
    if (within_ == "Topology") grid.cells = item;
    if (within_ == "Geometry") grid.points = item;
    if (within_ == "Attribute" && !grid.attributes.empty()) grid.attributes.back().item = item;
  }

  /// The file and the path in it that an item names: "mesh.h5:/Mesh/mesh/topology".
  std::pair<const Hdf5Reader*, std::string> at(const Item& item) {
    std::string text(item.text);
    text.erase(0, text.find_first_not_of(" \t\r\n"));
    text.erase(std::min(text.size(), text.find_last_not_of(" \t\r\n") + 1));
    const std::size_t colon = text.rfind(':');
    if (colon == std::string::npos || colon == 0)
      input_.fail_at_line(item.at, fmt::format("expected FILE:/PATH, found {}", in_quotes(text)));
    const std::string name = unescaped(text.substr(0, colon));
    // Values lie beside the file that names them: a path could lead anywhere.
    if (fs::path(name).has_parent_path())
      input_.fail_at_line(
          item.at, fmt::format("the values in {} are in another folder; move them beside this file", in_quotes(name)));
    auto& file = files_[name];
    if (!file) file = std::make_unique<Hdf5Reader>(named_file(input_, name), input_.name, input_.context);
    return {file.get(), text.substr(colon + 1)};
  }

  template <class Take>
  void for_each_word(const Item& item, const Take& take) {
    Input part = input_;
    part.bytes =
        input_.bytes.substr(0, static_cast<std::size_t>(item.text.data() + item.text.size() - input_.bytes.data()));
    Scanner scan(part);
    scan.set_position(item.text.data());
    while (!scan.at_end()) take(scan);
  }

  const Input& input_;
  XmlTags tags_;
  std::vector<ReadGrid> grids_;
  std::string_view within_;
  std::map<std::string, std::unique_ptr<Hdf5Reader>> files_;
};

class Xdmf {
 public:
  explicit Xdmf(const Input& input) : input_(input) { raw_.format = "XDMF"; }

  RawMesh read() {
    read_file(input_);
    const fs::path path(input_.name);
    for (const char* further : {"_patches.xdmf", "_curves.xdmf"}) {
      const fs::path file = named_file(input_, path.stem().string() + further);
      std::error_code error;
      if (!fs::exists(file, error)) continue;
      const LoadedFile loaded(file, input_.context);
      read_file(loaded.input());
    }
    return std::move(raw_);
  }

 private:
  void read_file(const Input& input) {
    XdmfFile file(input);
    for (const ReadGrid& grid : file.grids()) read_grid(input, file, grid);
  }

  void read_grid(const Input& input, XdmfFile& file, const ReadGrid& grid) {
    if (!grid.cells || !grid.points) return;
    if (raw_.points.empty()) {
      const std::vector<double> xyz = file.reals(*grid.points, 0);
      if (xyz.size() % 3 != 0 || xyz.size() / 3 >= kNone) input.fail("has coordinates that are not of dimension 3");
      for (std::size_t i = 0; i < xyz.size(); i += 3) raw_.points.push_back({xyz[i], xyz[i + 1], xyz[i + 2]});
      for (const Vec3& p : raw_.points)
        if (!is_finite(p)) input.fail(fmt::format("has a point ({}, {}, {}), which is no place", p.x, p.y, p.z));
    }
    const std::vector<std::int64_t> cells = file.integers(*grid.cells);
    VtkCellData data;
    std::uint64_t count = count_cells(input, grid, cells);
    take_attributes(file, grid, count, data);
    VtkCellTaker taker(input, raw_, data, kXdmfWide);
    for_each_cell(input, grid, cells, [&](std::uint64_t c, std::int64_t vtk, std::span<const std::int64_t> nodes) {
      taker.take(c, vtk, nodes);
    });
    taker.finish();
    for (const auto& [name, value] : grid.names) take_name(name, value);
  }

  template <class Visit>
  static void for_each_cell(const Input& input, const ReadGrid& grid, std::span<const std::int64_t> cells,
                            const Visit& visit) {
    const auto type =
        std::find_if(kXdmfCells.begin(), kXdmfCells.end(), [&](const XdmfCell& t) { return t.name == grid.topology; });
    if (grid.topology != "mixed" && type == kXdmfCells.end())
      input.fail(fmt::format("elements of type {} are not known here", in_quotes(grid.topology)));
    std::uint64_t c = 0;
    for (std::size_t at = 0; at < cells.size(); ++c) {
      const XdmfCell* of = grid.topology != "mixed" ? &*type : nullptr;
      if (of == nullptr) {
        const std::int64_t number = cells[at++];
        const auto found =
            std::find_if(kXdmfCells.begin(), kXdmfCells.end(), [&](const XdmfCell& t) { return t.number == number; });
        if (found == kXdmfCells.end()) input.fail(fmt::format("elements of type {} are not known here", number));
        of = &*found;
        // Lines and points say how many nodes they have.
        if (number <= 2 && at < cells.size()) ++at;
      }
      if (cells.size() - at < of->nodes) input.fail("its list of elements ends within one; it is damaged");
      visit(c, of->vtk, cells.subspan(at, of->nodes));
      at += of->nodes;
    }
  }

  static std::uint64_t count_cells(const Input& input, const ReadGrid& grid, std::span<const std::int64_t> cells) {
    std::uint64_t count = 0;
    for_each_cell(input, grid, cells, [&](std::uint64_t, std::int64_t, std::span<const std::int64_t>) { ++count; });
    return count;
  }

  void take_attributes(XdmfFile& file, const ReadGrid& grid, std::uint64_t count, VtkCellData& data) {
    for (const Attribute& attribute : grid.attributes) {
      const std::string& name = attribute.name;
      std::vector<std::int64_t>* const to = name == "region"                                 ? &data.region
                                            : name == "patch"                                ? &data.patch
                                            : name == "curve"                                ? &data.curve
                                            : name == "gmsh:physical" || name == "medit:ref" ? &data.region
                                                                                             : nullptr;
      if (attribute.item.at != nullptr && !is_numbering(name) && raw_.field.offer(input_, name)) {
        std::vector<double> values = file.reals(attribute.item, 0);
        if (attribute.of_nodes && values.size() == raw_.points.size()) raw_.field.at_points = std::move(values);
        if (!attribute.of_nodes && values.size() == count) data.field = std::move(values);
        continue;
      }
      if (attribute.item.at == nullptr || (to == nullptr && !is_set_name(name))) continue;
      std::vector<std::int64_t> values = file.integers(attribute.item);
      if (attribute.of_nodes) {
        if (values.size() == raw_.points.size()) add_node_set(raw_, name, values);
      } else if (values.size() == count) {
        if (to != nullptr) {
          *to = std::move(values);
          if (to == &data.region && name != "region") data.patch = data.region;
        } else {
          data.sets.emplace_back(name, std::move(values));
        }
      }
    }
  }

  /// "patch 3" and its name.
  void take_name(const std::string& name, const std::string& value) {
    const std::size_t blank = name.find(' ');
    std::int64_t number = 0;
    if (blank == std::string::npos) return;
    if (std::from_chars(name.data() + blank + 1, name.data() + name.size(), number).ec != std::errc()) return;
    if (number > std::int64_t{kNone}) return;
    add_vtk_name(raw_, name.substr(0, blank) + " " + value, number - 1);
  }

  const Input& input_;
  RawMesh raw_;
};

}  // namespace

RawMesh read_xdmf(const Input& input) {
  return Xdmf(input).read();
}

}  // namespace octafront::io
