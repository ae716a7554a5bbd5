// XDMF 3 as FEniCSx, ParaView and meshio read it: NAME.xdmf with one grid of tetrahedra (of mixed elements, where there
// are wedges and pyramids), NAME_patches.xdmf and
// NAME_curves.xdmf with those of faces and edges, each with its values in a file .h5 of the same stem, where FEniCSx
// looks for them. Regions, patches and curves are attributes of
// cells, counted from 1; sets are attributes that are 1 for members ("elements NAME", "nodes NAME" ...). Names stand
// in the tags of these attributes: name_1="inlet".

#include "formats/containers/hdf5_file.h"
#include "formats/containers/text_writer.h"
#include "formats/containers/vtk_xml.h"
#include "formats/parts/mixed_cells.h"
#include "formats/write/writers.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>

#include <fmt/core.h>

namespace octafront::io {
namespace {

using Kind = NamedSet::Kind;
using Origin = Part::Origin;

/// A kind of element and how XDMF calls it.
struct WrittenGrid {
  const char* name;
  Kind kind;
  Origin origin;
  const char* number;  ///< the attribute with the number of the part
  const char* prefix;  ///< of the attributes of sets
  std::array<const char*, 2> topology;
};
constexpr WrittenGrid kMesh{"mesh",   Kind::kElements, Origin::kRegion,
                            "region", "elements ",     {"Tetrahedron", "Tetrahedron_10"}},
    kPatches{"patches", Kind::kFaces, Origin::kPatch, "patch", "faces ", {"Triangle", "Triangle_6"}},
    kCurves{"curves", Kind::kEdges, Origin::kCurve, "curve", "edges ", {"Polyline", "Edge_3"}};

class XdmfWriter {
 public:
  XdmfWriter(MeshOutput& out, const MeshParts& mesh)
      : out_(out), mesh_(mesh), cells_(mesh), stem_(out.target().stem().string()) {}

  void write() {
    write_file(kMesh, stem_, out_.file());
    // Empty ones too: older files of these names would be taken for ours.
    for (const WrittenGrid& grid : {kPatches, kCurves}) {
      const std::string stem = stem_ + "_" + grid.name;
      write_file(grid, stem, out_.beside(stem + ".xdmf"));
    }
  }

 private:
  std::uint64_t count(const WrittenGrid& grid) const {
    return grid.kind == Kind::kElements ? cells_.cells() : grid.kind == Kind::kFaces ? cells_.faces() : mesh_.edges();
  }
  std::uint64_t nodes_of(const WrittenGrid& grid, std::uint64_t i) const {
    if (grid.kind == Kind::kElements) return cells_.nodes_per(cells_.kind(i));
    if (grid.kind == Kind::kEdges) return mesh_.nodes_per_edge();
    return i < cells_.triangles() ? mesh_.nodes_per_face() : cells_.nodes_per_quad();
  }
  VertexIndex node(const WrittenGrid& grid, std::uint64_t i, std::uint64_t k) const {
    return grid.kind == Kind::kElements ? cells_.node(i, k, kXdmfWide)
           : grid.kind == Kind::kFaces  ? cells_.face_node(i, k)
                                        : mesh_.edge_node(i, k);
  }
  bool is_mixed(const WrittenGrid& grid) const {
    return grid.kind == Kind::kElements ? !mesh_.wide_cells().empty() : grid.kind == Kind::kFaces && cells_.quads() > 0;
  }

  void item(TextWriter& out, const std::string& shape, std::string_view type, std::size_t precision,
            const std::string& file, const std::string& path) {
    out.line("        <DataItem Dimensions=\"{}\" NumberType=\"{}\" Precision=\"{}\" Format=\"HDF\">{}:{}</DataItem>",
             shape, type, precision, escaped(file), path);
  }

  void write_file(const WrittenGrid& grid, const std::string& stem, AtomicFile& file) {
    h5_ = stem + ".h5";
    values_.emplace(out_.path_for_library(h5_), out_.target().string(), out_.context());
    values_->group("/Mesh");
    write_grid(grid, file);
    values_->close();
  }

  void write_grid(const WrittenGrid& grid, AtomicFile& file) {
    TextWriter out(file);
    const std::string group = std::string("/Mesh/") + grid.name;
    values_->group(group);
    const std::uint64_t n = count(grid);
    out << "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n  <Domain>\n";
    out.line("    <Grid Name=\"{}\" GridType=\"Uniform\">", grid.name);
    is_mixed(grid) ? write_mixed_topology(out, grid, group + "/topology")
                   : write_topology(out, grid, group + "/topology");
    out << "      </Topology>\n      <Geometry GeometryType=\"XYZ\">\n";
    item(out, fmt::format("{} 3", mesh_.points()), "Float", 8, stem_ + ".h5", "/Mesh/mesh/geometry");
    if (grid.kind == Kind::kElements) write_points(group + "/geometry");
    out << "      </Geometry>\n";
    // Names are attributes of XML, which all readers pass over; <Information> stops some.
    std::string names;
    for (const Part& part : mesh_.parts(grid.origin))
      if (part.is_named) names += fmt::format(" name_{}=\"{}\"", part.tag, escaped(part.name));
    write_attribute(out, fmt::format("{}\"{}", grid.number, names), "Cell", group + "/numbers", n,
                    [&](std::uint64_t i) { return number(grid, i); });
    std::size_t sets = 0;
    for (const Part& part : mesh_.parts(Origin::kSet)) {
      const bool of_nodes = part.kind == Kind::kNodes && grid.kind == Kind::kElements;
      if (part.kind == grid.kind || of_nodes)
        write_set(out, (of_nodes ? "nodes " : grid.prefix) + part.name, part, of_nodes ? mesh_.points() : n,
                  fmt::format("{}/set_{}", group, ++sets));
    }
    if (grid.kind == Kind::kElements) write_fields(out, group);
    out << "    </Grid>\n  </Domain>\n</Xdmf>\n";
  }

  std::int32_t number(const WrittenGrid& grid, std::uint64_t i) const {
    return static_cast<std::int32_t>(
        grid.kind == Kind::kElements ? mesh_.tag_of_region(mesh_.region_of(cells_.first_tet(i)))
        : grid.kind == Kind::kFaces  ? mesh_.tag_of(Part::Origin::kPatch, mesh_.patch_of(cells_.first_face(i)))
                                     : mesh_.tag_of(Part::Origin::kCurve, mesh_.curve_of(i)));
  }

  void write_topology(TextWriter& out, const WrittenGrid& grid, const std::string& path) {
    const std::uint64_t n = count(grid), each = n == 0 ? 1 : nodes_of(grid, 0);
    out.line("      <Topology TopologyType=\"{}\" NumberOfElements=\"{}\" NodesPerElement=\"{}\">",
             grid.topology[mesh_.second_order()], n, each);
    item(out, fmt::format("{} {}", n, each), "Int", 8, h5_, path);
    values_->values<std::int64_t>(path, {n, each}, [&](std::uint64_t i) { return node(grid, i / each, i % each); });
  }

  /// Each element behind the number of its type.
  void write_mixed_topology(TextWriter& out, const WrittenGrid& grid, const std::string& path) {
    std::vector<std::int64_t> all;
    for (std::uint64_t i = 0; i < count(grid); ++i) {
      all.push_back(mixed_type(nodes_of(grid, i), grid.kind));
      for (std::uint64_t k = 0; k < nodes_of(grid, i); ++k) all.push_back(node(grid, i, k));
    }
    out.line("      <Topology TopologyType=\"Mixed\" NumberOfElements=\"{}\">", count(grid));
    item(out, std::to_string(all.size()), "Int", 8, h5_, path);
    values_->values<std::int64_t>(path, {all.size()}, [&](std::uint64_t i) { return all[i]; });
  }

  static std::int64_t mixed_type(std::uint64_t nodes, Kind kind) {
    if (kind == Kind::kFaces) return nodes == 3 ? 4 : nodes == 4 ? 5 : nodes == 6 ? 36 : 37;
    return nodes == 4 ? 6 : nodes == 5 ? 7 : nodes == 6 ? 8 : nodes == 10 ? 38 : nodes == 13 ? 39 : 40;
  }

  void write_points(const std::string& path) {
    values_->values<double>(path, {mesh_.points(), 3},
                            [&](std::uint64_t i) { return mesh_.mesh().points[i / 3][static_cast<int>(i % 3)]; });
  }

  void write_fields(TextWriter& out, const std::string& group) {
    std::size_t number = 0;
    for (const MeshField& field : out_.fields()) {
      const std::uint64_t each = field.components, n = cells_.items(field);
      out.line("      <Attribute AttributeType=\"{}\" Center=\"{}\" Name=\"{}\">", each == 1 ? "Scalar" : "Matrix",
               field.of_elements ? "Cell" : "Node", escaped(field.name));
      const std::string path = fmt::format("{}/field_{}", group, ++number);
      item(out, fmt::format("{} {}", n, each), "Float", 8, h5_, path);
      out << "      </Attribute>\n";
      values_->values<double>(path, {n, each},
                              [&](std::uint64_t i) { return cells_.value_of(field, i / each, i % each); });
    }
  }

  /// `name` with the quote behind it, and more attributes of XML if there are any.
  template <class ValueAt>
  void write_attribute(TextWriter& out, const std::string& name, std::string_view center, const std::string& path,
                       std::uint64_t n, const ValueAt& value_at) {
    out.line("      <Attribute AttributeType=\"Scalar\" Center=\"{}\" Name=\"{}>", center, name);
    item(out, fmt::format("{} 1", n), "Int", 4, h5_, path);
    out << "      </Attribute>\n";
    values_->values<std::int32_t>(path, {n, 1}, value_at);
  }

  void write_set(TextWriter& out, const std::string& name, const Part& part, std::uint64_t n, const std::string& path) {
    std::vector<bool> is_in(n, false);
    for (const std::uint32_t m : cells_.members(part)) is_in[m] = true;
    write_attribute(out, escaped(name) + '"', part.kind == Kind::kNodes ? "Node" : "Cell", path, n,
                    [&](std::uint64_t i) { return std::int32_t{is_in[i]}; });
  }

  MeshOutput& out_;
  const MeshParts& mesh_;
  MixedCells cells_;
  std::string stem_, h5_;             ///< of the target; and the file of values_
  std::optional<Hdf5Writer> values_;  ///< of the grid that is being written
};

}  // namespace

void write_xdmf(MeshOutput& out, const MeshParts& mesh) {
  XdmfWriter(out, mesh).write();
}

}  // namespace octafront::io
