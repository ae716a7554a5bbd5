// CGNS in HDF5, by the mapping of the SIDS to HDF5 (every node is a group with the attributes name, label, type and
// flags, and its values in " data"): one base, one unstructured zone, a section of elements per region, patch and
// curve, and a boundary condition with a family for each patch. Numbers count from 1; names have 32 characters.

#include <octafront/error.h>

#include "formats/containers/hdf5_file.h"
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

class CgnsWriter {
 public:
  CgnsWriter(MeshOutput& out, const MeshParts& mesh)
      : file_(out.path_for_library(), out.target().string(), out.context(), true),
        mesh_(mesh),
        names_(legal_names(out, mesh, {.longest = 32, .also = " _-.+#()[]{}<>=&%$!?*'\"", .letter_first = false},
                           std::array{Origin::kRegion, Origin::kPatch, Origin::kCurve})) {}

  void write() {
    write_root();
    write_base();
    const std::string zone = "/Base/Zone";
    node(zone, "Zone_t", "I4");
    data<std::int32_t>(zone, {3, 1}, [&](std::uint64_t i) {
      return static_cast<std::int32_t>(i == 0 ? mesh_.points() : i == 1 ? mesh_.tets() : 0);
    });
    text(zone + "/ZoneType", "ZoneType_t", "Unstructured");
    write_coordinates(zone + "/GridCoordinates");
    for (std::size_t p = 0; p < names_.size(); ++p)
      if (mesh_.parts()[p].origin != Origin::kSet) write_section(zone, p);
    node(zone + "/ZoneBC", "ZoneBC_t", "MT");
    for (std::size_t p = 0; p < names_.size(); ++p)
      if (mesh_.parts()[p].origin == Origin::kPatch) write_condition(zone + "/ZoneBC/", p);
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

  /// A section is a run of elements: the parts follow each other.
  void write_section(const std::string& zone, std::size_t p) {
    constexpr std::array<std::array<std::int32_t, 2>, 4> kTypes{{{2, 2}, {3, 4}, {5, 6}, {10, 11}}};
    const Part& part = mesh_.parts()[p];
    const std::string prefix = part.kind == Kind::kElements ? "" : part.kind == Kind::kFaces ? "faces " : "edges ";
    const std::string section = zone + "/" + (prefix + names_[p]).substr(0, kName - 1);
    const std::int32_t type = kTypes[static_cast<std::size_t>(part.kind)][mesh_.second_order()];
    const std::int32_t first = next_, last = first + static_cast<std::int32_t>(part.members.size()) - 1;
    next_ = last + 1;
    if (first_of_.size() < names_.size()) first_of_.resize(names_.size());
    first_of_[p] = first;
    node(section, "Elements_t", "I4");
    data<std::int32_t>(section, {2}, [&](std::uint64_t i) { return i == 0 ? type : 0; });
    node(section + "/ElementRange", "IndexRange_t", "I4");
    data<std::int32_t>(section + "/ElementRange", {2}, [&](std::uint64_t i) { return i == 0 ? first : last; });
    node(section + "/ElementConnectivity", "DataArray_t", "I4");
    const std::uint64_t each = part.kind == Kind::kElements ? mesh_.nodes_per_tet()
                               : part.kind == Kind::kFaces  ? mesh_.nodes_per_face()
                                                            : mesh_.nodes_per_edge();
    data<std::int32_t>(section + "/ElementConnectivity", {each * part.members.size()}, [&](std::uint64_t i) {
      const std::uint32_t m = part.members[i / each];
      const std::uint64_t k = i % each;
      return 1 + static_cast<std::int32_t>(part.kind == Kind::kElements ? mesh_.tet_node(m, k)
                                           : part.kind == Kind::kFaces  ? mesh_.face_node(m, k)
                                                                        : mesh_.edge_node(m, k));
    });
  }

  void write_condition(const std::string& conditions, std::size_t p) {
    const std::string path = conditions + names_[p];
    const auto size = static_cast<std::int32_t>(mesh_.parts()[p].members.size());
    text(path, "BC_t", "FamilySpecified");
    node(path + "/PointRange", "IndexRange_t", "I4");
    data<std::int32_t>(path + "/PointRange", {2, 1},
                       [&](std::uint64_t i) { return i == 0 ? first_of_[p] : first_of_[p] + size - 1; });
    text(path + "/FamilyName", "FamilyName_t", names_[p]);
    text(path + "/GridLocation", "GridLocation_t", "FaceCenter");
  }

  Hdf5Writer file_;
  const MeshParts& mesh_;
  std::vector<std::string> names_;
  std::int32_t next_ = 1;               ///< the number of the next element
  std::vector<std::int32_t> first_of_;  ///< of the parts
};

}  // namespace

void write_cgns(MeshOutput& out, const MeshParts& mesh) {
  constexpr std::size_t kMost = std::numeric_limits<std::int32_t>::max();
  if (mesh.points() > kMost || mesh.tets() + mesh.faces() + mesh.edges() > kMost)
    throw OutputError(out.target().string() + ": too many elements for CGNS with 32 bits; write .vtu");
  CgnsWriter(out, mesh).write();
}

}  // namespace octafront::io
