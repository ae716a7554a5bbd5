// MED 4.0 in HDF5. Each combination of groups that elements are in is a family (negative; of nodes: positive); every
// region, patch, curve and set is a group of families. MED's tetrahedra turn the other way: their second and third
// corner are exchanged, and with them the mid-side nodes 12 and 13, and 24 and 34. Values are stored component by
// component.

#include <octafront/error.h>

#include "formats/containers/hdf5_file.h"
#include "formats/write/writers.h"

#include <array>
#include <limits>
#include <string>

#include <fmt/core.h>

namespace octafront::io {
namespace {

using Kind = NamedSet::Kind;

constexpr std::size_t kLongestGroup = 80, kLongestFamily = 64;

/// Of a kind of cell: MED's name and number, linear and of second order, and the places of our nodes in its list.
struct MedSection {
  Kind kind;
  std::array<const char*, 2> name;
  std::array<std::int32_t, 2> number;
  std::array<std::uint8_t, 10> order;
};
constexpr std::array kMedSections{
    MedSection{Kind::kElements, {"TE4", "T10"}, {304, 310}, {0, 2, 1, 3, 6, 5, 4, 7, 9, 8}},
    MedSection{Kind::kFaces, {"TR3", "TR6"}, {203, 206}, {0, 1, 2, 3, 4, 5}},
    MedSection{Kind::kEdges, {"SE2", "SE3"}, {102, 103}, {0, 1, 2}}};

class MedWriter {
 public:
  MedWriter(MeshOutput& out, const MeshParts& mesh)
      : file_(out.path_for_library(), out.target().string(), out.context(), true), mesh_(mesh) {}

  void write() {
    file_.group("/INFOS_GENERALES");
    file_.attribute("/INFOS_GENERALES", "MAJ", 4);
    file_.attribute("/INFOS_GENERALES", "MIN", 0);
    file_.attribute("/INFOS_GENERALES", "REL", 0);
    write_head();
    write_nodes();
    file_.group(kStep + "/MAI");
    file_.attribute(kStep + "/MAI", "CGT", 1);
    write_families_head();
    for (const MedSection& type : kMedSections) write_cells(type);
    file_.close();
  }

 private:
  static inline const std::string kMesh = "/ENS_MAA/mesh";
  static inline const std::string kStep = kMesh + "/-0000000000000000001-0000000000000000001";
  static inline const std::string kFamilies = "/FAS/mesh";

  void write_head() {
    file_.group("/ENS_MAA");
    file_.group(kMesh);
    const auto number = [&](const char* name, std::int32_t value) { file_.attribute(kMesh, name, value); };
    number("DIM", 3);
    number("ESP", 3);
    number("REP", 0);
    number("TYP", 0);
    number("SRT", 0);
    number("NXT", -1);
    number("NXI", -1);
    file_.attribute(kMesh, "DES", "mesh by octafront");
    file_.attribute(kMesh, "UNT", "", 1);
    file_.attribute(kMesh, "NOM", fmt::format("{:16}{:16}{:16}", "x", "y", "z"));
    file_.attribute(kMesh, "UNI", fmt::format("{:48}", ""));
    file_.group(kStep);
    for (const char* name : {"NDT", "NOR", "NXI", "NXT", "PVI", "PVT"}) file_.attribute(kStep, name, -1);
    file_.attribute(kStep, "CGT", 1);
    file_.attribute(kStep, "PDT", 0.0);
  }

  void write_nodes() {
    const std::string nodes = kStep + "/NOE";
    file_.group(nodes);
    file_.attribute(nodes, "CGT", 1);
    file_.attribute(nodes, "CGS", 1);
    file_.attribute(nodes, "PFL", "MED_NO_PROFILE_INTERNAL");
    const std::uint64_t n = mesh_.points();
    values<double>(nodes + "/COO", 3, n, [&](std::uint64_t component, std::uint64_t v) {
      return mesh_.mesh().points[v][static_cast<int>(component)];
    });
  }

  /// A dataset component by component, with the attributes that all have.
  template <class T, class ValueAt>
  void values(const std::string& path, std::uint64_t components, std::uint64_t count, const ValueAt& value_at) {
    file_.dataset(path, {components * count}, Hdf5Writer::Fill<T>([&](std::uint64_t first, std::span<T> to) {
                    for (std::uint64_t i = 0; i < to.size(); ++i)
                      to[i] = static_cast<T>(value_at((first + i) / count, (first + i) % count));
                  }));
    file_.attribute(path, "CGT", 1);
    file_.attribute(path, "NBR", static_cast<std::int32_t>(count));
  }

  void write_families_head() {
    file_.group("/FAS");
    file_.group(kFamilies);
    file_.group(kFamilies + "/FAMILLE_ZERO");
    file_.attribute(kFamilies + "/FAMILLE_ZERO", "NUM", 0);
    const Combinations of_nodes = combinations(mesh_, Kind::kNodes);
    if (!of_nodes.parts.empty()) {
      file_.group(kFamilies + "/NOEUD");
      for (std::size_t c = 0; c < of_nodes.parts.size(); ++c)
        write_family(kFamilies + "/NOEUD", static_cast<std::int32_t>(c) + 1, of_nodes.parts[c]);
      values<std::int32_t>(kStep + "/NOE/FAM", 1, mesh_.points(), [&](std::uint64_t, std::uint64_t v) {
        return of_nodes.of[v] == kNone ? 0 : static_cast<std::int32_t>(of_nodes.of[v]) + 1;
      });
    }
    file_.group(kFamilies + "/ELEME");
  }

  void write_family(const std::string& group, std::int32_t number, const std::vector<std::uint32_t>& parts) {
    // Names of families must not have the "/" of HDF5's paths.
    const std::string family = group + fmt::format("/FAM_{}", number);
    file_.group(family);
    file_.attribute(family, "NUM", number);
    file_.group(family + "/GRO");
    file_.attribute(family + "/GRO", "NBR", static_cast<std::int32_t>(parts.size()));
    std::vector<std::string> names;
    for (const std::uint32_t p : parts) names.push_back(one_line(mesh_.parts()[p].name).substr(0, kLongestGroup));
    file_.texts(family + "/GRO/NOM", names, kLongestGroup);
  }

  void write_cells(const MedSection& type) {
    const Combinations families = combinations(mesh_, type.kind);
    const std::uint64_t count = families.of.size();
    if (count == 0) return;
    const std::int32_t first = next_family_;
    for (const auto& parts : families.parts) write_family(kFamilies + "/ELEME", next_family_--, parts);
    const std::string cells = kStep + "/MAI/" + type.name[mesh_.second_order()];
    file_.group(cells);
    file_.attribute(cells, "CGT", 1);
    file_.attribute(cells, "CGS", 1);
    file_.attribute(cells, "GEO", type.number[mesh_.second_order()]);
    file_.attribute(cells, "PFL", "MED_NO_PROFILE_INTERNAL");
    const std::uint64_t nodes = type.kind == Kind::kElements ? mesh_.nodes_per_tet()
                                : type.kind == Kind::kFaces  ? mesh_.nodes_per_face()
                                                             : mesh_.nodes_per_edge();
    values<std::int32_t>(cells + "/NOD", nodes, count, [&](std::uint64_t k, std::uint64_t i) {
      const std::uint64_t at = type.order[k];
      return 1 + (type.kind == Kind::kElements ? mesh_.tet_node(i, at)
                  : type.kind == Kind::kFaces  ? mesh_.face_node(i, at)
                                               : mesh_.edge_node(i, at));
    });
    values<std::int32_t>(cells + "/FAM", 1, count, [&](std::uint64_t, std::uint64_t i) {
      return first - static_cast<std::int32_t>(families.of[i]);
    });
  }

  Hdf5Writer file_;
  const MeshParts& mesh_;
  std::int32_t next_family_ = -1;
};

}  // namespace

void write_med(MeshOutput& out, const MeshParts& mesh) {
  constexpr std::size_t kMost = std::numeric_limits<std::int32_t>::max();
  if (mesh.points() > kMost || mesh.tets() > kMost)
    throw OutputError(out.target().string() + ": MED files have 32-bit numbers, too few for this mesh; write .vtu");
  MedWriter(out, mesh).write();
}

}  // namespace octafront::io
