// CGNS in HDF5, by the mapping of the SIDS to HDF5 (every node is a group with the attributes name, label, type and
// flags, and its values in " data"): one base, one unstructured zone, a section of elements per region, patch and
// curve (and kind of element: wedges, pyramids and quadrilaterals are sections behind), and a boundary condition with a
// family for each patch. Fields are solutions at vertices and in cells, vectors as VelocityX to VelocityZ. Numbers
// count from 1; names have 32 characters.

#include <octafront/error.h>

#include "formats/containers/hdf5_file.h"
#include "formats/parts/field_columns.h"
#include "formats/parts/mixed_cells.h"
#include "formats/write/writers.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <string>

#include <fmt/core.h>

namespace octafront::io {
namespace {

using Kind = NamedSet::Kind;
using Origin = Part::Origin;

constexpr std::size_t kName = 33;
constexpr NameRules kRules{.longest = 32, .also = " _-.+#()[]{}<>=&%$!?*'\"", .letter_first = false};

class CgnsWriter {
 public:
  CgnsWriter(MeshOutput& out, const MeshParts& mesh)
      : file_(out.path_for_library(), out.target().string(), out.context(), true),
        mesh_(mesh),
        cells_(mesh),
        names_(legal_names(out, mesh, kRules, std::array{Origin::kRegion, Origin::kPatch, Origin::kCurve})),
        of_nodes_(field_columns(out, false, kRules, ComponentNames::kCapitals)),
        of_cells_(field_columns(out, true, kRules, ComponentNames::kCapitals)) {}

  void write() {
    write_root();
    write_base();
    const std::string zone = "/Base/Zone";
    node(zone, "Zone_t", "I4");
    data<std::int32_t>(zone, {3, 1}, [&](std::uint64_t i) {
      return static_cast<std::int32_t>(i == 0 ? mesh_.points() : i == 1 ? cells_.cells() : 0);
    });
    text(zone + "/ZoneType", "ZoneType_t", "Unstructured");
    write_coordinates(zone + "/GridCoordinates");
    for (std::size_t p = 0; p < names_.size(); ++p)
      if (mesh_.parts()[p].origin != Origin::kSet) write_sections(zone, p);
    node(zone + "/ZoneBC", "ZoneBC_t", "MT");
    for (std::size_t p = 0; p < names_.size(); ++p)
      if (mesh_.parts()[p].origin == Origin::kPatch) write_condition(zone + "/ZoneBC/", p);
    write_solution(zone + "/Vertex solution", "Vertex", of_nodes_);
    write_solution(zone + "/Cell solution", "CellCenter", of_cells_);
    file_.close();
  }

 private:
  void attributes(const std::string& path, const std::string& name, const char* label, const char* type) {
    file_.attribute(path, "name", name, kName);
    file_.attribute(path, "label", label, kName);
    file_.attribute(path, "type", type, 3);
  }

  void node(const std::string& path, const char* label, const char* type) {
    file_.group(path);
    attributes(path, path.substr(path.rfind('/') + 1), label, type);
    file_.attribute(path, "flags", std::vector<std::int32_t>{1});
  }

  template <class T, class ValueAt>
  void data(const std::string& path, const std::vector<std::uint64_t>& shape, const ValueAt& value_at) {
    file_.dataset(path + "/ data", shape, Hdf5Writer::Fill<T>([&](std::uint64_t first, std::span<T> to) {
                    for (std::uint64_t i = 0; i < to.size(); ++i) to[i] = value_at(first + i);
                  }));
  }

  void text(const std::string& path, const char* label, const std::string& words) {
    node(path, label, "C1");
    data<std::int8_t>(path, {words.size()}, [&](std::uint64_t i) { return static_cast<std::int8_t>(words[i]); });
  }

  void write_root() {
    attributes("/", "HDF5 MotherNode", "Root Node of HDF5 File", "MT");
    const auto words = [&](const char* path, const std::string& value, std::size_t length) {
      file_.dataset(path, {length}, Hdf5Writer::Fill<std::int8_t>([&](std::uint64_t first, std::span<std::int8_t> to) {
                      for (std::uint64_t i = 0; i < to.size(); ++i)
                        to[i] = first + i < value.size() ? static_cast<std::int8_t>(value[first + i]) : std::int8_t{0};
                    }));
    };
    words("/ format", "IEEE_LITTLE_32", 15);
    words("/ hdf5version", "HDF5 Version 1.8.0", kName);
    node("/CGNSLibraryVersion", "CGNSLibraryVersion_t", "R4");
    data<float>("/CGNSLibraryVersion", {1}, [](std::uint64_t) { return 3.4F; });
  }

  void write_base() {
    node("/Base", "CGNSBase_t", "I4");
    data<std::int32_t>("/Base", {2}, [](std::uint64_t) { return 3; });
    for (std::size_t p = 0; p < names_.size(); ++p)
      if (mesh_.parts()[p].origin == Origin::kPatch) node("/Base/" + names_[p], "Family_t", "MT");
  }

  void write_coordinates(const std::string& path) {
    node(path, "GridCoordinates_t", "MT");
    for (int axis = 0; axis < 3; ++axis) {
      const std::string of_axis = path + "/Coordinate" + "XYZ"[axis];
      node(of_axis, "DataArray_t", "R8");
      data<double>(of_axis, {mesh_.points()}, [&](std::uint64_t v) { return mesh_.mesh().points[v][axis]; });
    }
  }

  /// What CGNS calls a kind of element, linear and of second order, and what tells its sections apart.
  struct SectionType {
    std::array<std::int32_t, 2> number;
    const char* suffix;
  };

  SectionType type_of(Kind kind, std::uint32_t element) const {
    constexpr std::array<SectionType, MixedCells::kKinds> kSolids{
        SectionType{{10, 11}, ""}, SectionType{{12, 21}, " pyramids"}, SectionType{{14, 15}, " wedges"}};
    if (kind == Kind::kElements) return kSolids[cells_.kind(element)];
    if (kind == Kind::kFaces)
      return element < cells_.triangles() ? SectionType{{5, 6}, ""} : SectionType{{7, 8}, " quads"};
    return {{3, 4}, ""};
  }

  std::size_t nodes_of(Kind kind, std::uint32_t element) const {
    if (kind == Kind::kElements) return cells_.nodes_per(cells_.kind(element));
    if (kind == Kind::kEdges) return mesh_.nodes_per_edge();
    return element < cells_.triangles() ? mesh_.nodes_per_face() : cells_.nodes_per_quad();
  }

  /// The sections of a part: the parts follow each other.
  void write_sections(const std::string& zone, std::size_t p) {
    const Part& part = mesh_.parts()[p];
    const std::vector<std::uint32_t> all = cells_.members(part);
    if (part.kind == Kind::kElements) order_.insert(order_.end(), all.begin(), all.end());
    ranges_.resize(names_.size());
    ranges_[p][0] = next_;
    for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
      const SectionType type = type_of(part.kind, all[begin]);
      while (end < all.size() && type_of(part.kind, all[end]).number == type.number) ++end;
      const std::string prefix = part.kind == Kind::kElements ? "" : part.kind == Kind::kFaces ? "faces " : "edges ";
      const std::string suffix = begin == 0 ? "" : type.suffix;
      const std::string name = (prefix + names_[p]).substr(0, kName - 1 - suffix.size()) + suffix;
      write_section(zone + "/" + sections_.legal(name), part.kind, type, std::span(all).subspan(begin, end - begin));
    }
    ranges_[p][1] = next_ - 1;
  }

  /// Elements of one kind.
  void write_section(const std::string& section, Kind kind, const SectionType& type,
                     std::span<const std::uint32_t> elements) {
    const std::int32_t first = next_, last = first + static_cast<std::int32_t>(elements.size()) - 1;
    next_ = last + 1;
    node(section, "Elements_t", "I4");
    data<std::int32_t>(section, {2}, [&](std::uint64_t i) { return i == 0 ? type.number[mesh_.second_order()] : 0; });
    node(section + "/ElementRange", "IndexRange_t", "I4");
    data<std::int32_t>(section + "/ElementRange", {2}, [&](std::uint64_t i) { return i == 0 ? first : last; });
    node(section + "/ElementConnectivity", "DataArray_t", "I4");
    const std::uint64_t each = nodes_of(kind, elements.front());
    data<std::int32_t>(section + "/ElementConnectivity", {each * elements.size()}, [&](std::uint64_t i) {
      const std::uint32_t m = elements[i / each];
      const std::uint64_t k = i % each;
      return 1 + static_cast<std::int32_t>(kind == Kind::kElements ? cells_.node(m, k, kCgnsWide)
                                           : kind == Kind::kFaces  ? cells_.face_node(m, k)
                                                                   : mesh_.edge_node(m, k));
    });
  }

  void write_condition(const std::string& conditions, std::size_t p) {
    const std::string path = conditions + names_[p];
    text(path, "BC_t", "FamilySpecified");
    node(path + "/PointRange", "IndexRange_t", "I4");
    data<std::int32_t>(path + "/PointRange", {2, 1}, [&](std::uint64_t i) { return ranges_[p][i]; });
    text(path + "/FamilyName", "FamilyName_t", names_[p]);
    text(path + "/GridLocation", "GridLocation_t", "FaceCenter");
  }

  void write_solution(const std::string& path, const char* place, const std::vector<FieldColumn>& columns) {
    if (columns.empty()) return;
    node(path, "FlowSolution_t", "MT");
    text(path + "/GridLocation", "GridLocation_t", place);
    for (const FieldColumn& column : columns) {
      node(path + "/" + column.name, "DataArray_t", "R8");
      data<double>(path + "/" + column.name, {cells_.items(*column.field)}, [&](std::uint64_t i) {
        return cells_.value_of(*column.field, column.field->of_elements ? order_[i] : i, column.component);
      });
    }
  }

  Hdf5Writer file_;
  const MeshParts& mesh_;
  MixedCells cells_;
  std::vector<std::string> names_;
  LegalNames sections_{kRules};  ///< which names behind "faces " may be too long for
  std::vector<FieldColumn> of_nodes_, of_cells_;
  std::vector<std::uint32_t> order_;                 ///< cells as their sections stand
  std::int32_t next_ = 1;                            ///< the number of the next element
  std::vector<std::array<std::int32_t, 2>> ranges_;  ///< of the parts: their first and last elements
};

}  // namespace

void write_cgns(MeshOutput& out, const MeshParts& mesh) {
  constexpr std::size_t kMost = std::numeric_limits<std::int32_t>::max();
  if (mesh.points() > kMost || mesh.tets() + mesh.faces() + mesh.edges() > kMost)
    throw OutputError(out.target().string() + ": too many elements for CGNS with 32 bits; write .vtu");
  CgnsWriter(out, mesh).write();
}

}  // namespace octafront::io
