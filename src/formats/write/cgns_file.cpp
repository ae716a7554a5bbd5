#include "formats/write/cgns_file.h"

namespace octafront::io {
namespace {

using Origin = Part::Origin;

constexpr const char* kZone = "/Base/Zone";

}  // namespace

CgnsFile::CgnsFile(MeshOutput& out, const MeshParts& mesh, float version)
    : file_(out.path_for_library(), out.target().string(), out.context(), true),
      mesh_(mesh),
      names_(legal_names(out, mesh, kRules, std::array{Origin::kRegion, Origin::kPatch, Origin::kCurve})) {
  write_root(version);
  write_base();
}

void CgnsFile::attributes(const std::string& path, const std::string& name, const char* label, const char* type) {
  file_.attribute(path, "name", name, kName);
  file_.attribute(path, "label", label, kName);
  file_.attribute(path, "type", type, 3);
}

void CgnsFile::node(const std::string& path, const char* label, const char* type) {
  file_.group(path);
  attributes(path, path.substr(path.rfind('/') + 1), label, type);
  file_.attribute(path, "flags", std::vector<std::int32_t>{1});
}

void CgnsFile::text(const std::string& path, const char* label, const std::string& words) {
  node(path, label, "C1");
  data<std::int8_t>(path, {words.size()}, [&](std::uint64_t i) { return static_cast<std::int8_t>(words[i]); });
}

void CgnsFile::write_root(float version) {
  attributes("/", "HDF5 MotherNode", "Root Node of HDF5 File", "MT");
  const auto words = [&](const char* path, const std::string& value, std::size_t length) {
    file_.values<std::int8_t>(path, {length}, [&](std::uint64_t i) {
      return i < value.size() ? static_cast<std::int8_t>(value[i]) : std::int8_t{0};
    });
  };
  words("/ format", "IEEE_LITTLE_32", 15);
  words("/ hdf5version", "HDF5 Version 1.8.0", kName);
  node("/CGNSLibraryVersion", "CGNSLibraryVersion_t", "R4");
  data<float>("/CGNSLibraryVersion", {1}, [&](std::uint64_t) { return version; });
}

void CgnsFile::write_base() {
  node("/Base", "CGNSBase_t", "I4");
  data<std::int32_t>("/Base", {2}, [](std::uint64_t) { return 3; });
  for (std::size_t p = 0; p < names_.size(); ++p)
    if (mesh_.parts()[p].origin == Origin::kPatch) node("/Base/" + names_[p], "Family_t", "MT");
}

void CgnsFile::begin_zone(std::size_t points, std::size_t cells, const std::function<Vec3(std::uint64_t)>& place_of) {
  const std::string zone = kZone;
  node(zone, "Zone_t", "I4");
  data<std::int32_t>(zone, {3, 1}, [&](std::uint64_t i) {
    return static_cast<std::int32_t>(i == 0 ? points : i == 1 ? cells : 0);
  });
  text(zone + "/ZoneType", "ZoneType_t", "Unstructured");
  node(zone + "/GridCoordinates", "GridCoordinates_t", "MT");
  for (int axis = 0; axis < 3; ++axis)
    array<double>(zone + "/GridCoordinates/Coordinate" + "XYZ"[axis], "DataArray_t", points,
                  [&](std::uint64_t v) { return place_of(v)[axis]; });
}

std::string CgnsFile::section(const std::string& name, std::int32_t type, std::int32_t first, std::int32_t last) {
  const std::string path = std::string(kZone) + "/" + sections_.legal(name);
  node(path, "Elements_t", "I4");
  data<std::int32_t>(path, {2}, [&](std::uint64_t i) { return i == 0 ? type : 0; });
  node(path + "/ElementRange", "IndexRange_t", "I4");
  data<std::int32_t>(path + "/ElementRange", {2}, [&](std::uint64_t i) { return i == 0 ? first : last; });
  return path;
}

void CgnsFile::conditions(std::span<const std::array<std::int32_t, 2>> faces_of_parts) {
  const std::string conditions = std::string(kZone) + "/ZoneBC";
  node(conditions, "ZoneBC_t", "MT");
  for (std::size_t p = 0; p < names_.size(); ++p) {
    if (mesh_.parts()[p].origin != Origin::kPatch) continue;
    const std::string path = conditions + "/" + names_[p];
    text(path, "BC_t", "FamilySpecified");
    node(path + "/PointRange", "IndexRange_t", "I4");
    data<std::int32_t>(path + "/PointRange", {2, 1}, [&](std::uint64_t i) { return faces_of_parts[p][i]; });
    text(path + "/FamilyName", "FamilyName_t", names_[p]);
    text(path + "/GridLocation", "GridLocation_t", "FaceCenter");
  }
}

void CgnsFile::solution(const std::vector<FieldColumn>& columns, bool in_cells, std::uint64_t items,
                        const ValueOf& value_of) {
  if (columns.empty()) return;
  const std::string path = std::string(kZone) + (in_cells ? "/Cell solution" : "/Vertex solution");
  node(path, "FlowSolution_t", "MT");
  text(path + "/GridLocation", "GridLocation_t", in_cells ? "CellCenter" : "Vertex");
  for (const FieldColumn& column : columns)
    array<double>(path + "/" + column.name, "DataArray_t", items,
                  [&](std::uint64_t i) { return value_of(*column.field, i, column.component); });
}

}  // namespace octafront::io
