// MED 4.0 in HDF5. Each combination of groups that elements are in is a family (negative; of nodes: positive); every
// region, patch, curve and set is a group of families. MED's tetrahedra turn the other way: their second and third
// corner are exchanged, and with them the mid-side nodes 12 and 13, and 24 and 34; so do pyramids and wedges. Values
// are stored component by component. A field at nodes and one of elements that are of one name are one field of MED's.

#include <octafront/error.h>

#include "formats/containers/hdf5_file.h"
#include "formats/parts/field_columns.h"
#include "formats/parts/mixed_cells.h"
#include "formats/write/job_writers.h"
#include "formats/write/writers.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include <fmt/core.h>

namespace octafront::io {
namespace {

using Kind = NamedSet::Kind;

constexpr std::size_t kLongestGroup = 80, kLongestFamily = 64, kLongestField = 64;

/// Of a kind of cell: MED's name and number, linear and of second order.
struct MedSection {
  std::array<const char*, 2> name;
  std::array<std::int32_t, 2> number;
};
constexpr std::array<MedSection, MixedCells::kKinds> kMedSolids{
    MedSection{{"TE4", "T10"}, {304, 310}}, {{"PY5", "P13"}, {305, 313}}, {{"PE6", "P15"}, {306, 315}}};
constexpr MedSection kMedTriangles{{"TR3", "TR6"}, {203, 206}}, kMedQuads{{"QU4", "QU8"}, {204, 208}},
    kMedEdges{{"SE2", "SE3"}, {102, 103}};
/// Places of our nodes in MED's list.
constexpr std::array<std::uint8_t, 10> kMedTet{0, 2, 1, 3, 6, 5, 4, 7, 9, 8};

class MedWriter {
 public:
  /// `names`: of groups and further nodes of a job; null: the mesh alone.
  MedWriter(MeshOutput& out, const MeshParts& mesh, const AsterNames* names)
      : file_(out.path_for_library(), out.target().string(), out.context(), true),
        mesh_(mesh),
        cells_(mesh),
        fields_(fields_of(out)) {
    if (names != nullptr) names_ = names->parts, points_ = names->points;
    for (const Part& part : mesh.parts())
      if (names == nullptr) names_.push_back(groups_.fitting(one_line(part.name)));
  }

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
    write_solids();
    write_faces();
    write_edges();
    if (!fields_.empty()) file_.group("/CHA");
    for (const MedField& field : fields_) write_field(field);
    file_.close();
  }

 private:
  static inline const std::string kMesh = "/ENS_MAA/mesh";
  static inline const std::string kNoTime = "/-0000000000000000001-0000000000000000001", kStep = kMesh + kNoTime;
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
    values<double>(nodes + "/COO", 3, nodes_in_all(), [&](std::uint64_t component, std::uint64_t v) {
      const std::size_t own = mesh_.points();
      return (v < own ? mesh_.mesh().points[v] : points_[v - own].at)[static_cast<int>(component)];
    });
  }

  /// With reference points.
  std::uint64_t nodes_in_all() const { return mesh_.points() + points_.size(); }

  /// A dataset component by component, with the attributes that all have.
  template <class T, class ValueAt>
  void values(const std::string& path, std::uint64_t components, std::uint64_t count, const ValueAt& value_at) {
    file_.values<T>(path, {components * count},
                    [&](std::uint64_t i) { return static_cast<T>(value_at(i / count, i % count)); });
    file_.attribute(path, "CGT", 1);
    file_.attribute(path, "NBR", static_cast<std::int32_t>(count));
  }

  void write_families_head() {
    file_.group("/FAS");
    file_.group(kFamilies);
    file_.group(kFamilies + "/FAMILLE_ZERO");
    file_.attribute(kFamilies + "/FAMILLE_ZERO", "NUM", 0);
    const Combinations of_nodes = combinations(mesh_, Kind::kNodes);
    if (const std::size_t families = of_nodes.parts.size(); families + points_.size() > 0) {
      file_.group(kFamilies + "/NOEUD");
      for (std::size_t c = 0; c < families; ++c)
        write_family(kFamilies + "/NOEUD", static_cast<std::int32_t>(c) + 1, names_of(of_nodes.parts[c]));
      for (std::size_t p = 0; p < points_.size(); ++p)
        write_family(kFamilies + "/NOEUD", static_cast<std::int32_t>(families + p) + 1, {points_[p].name});
      values<std::int32_t>(kStep + "/NOE/FAM", 1, nodes_in_all(), [&](std::uint64_t, std::uint64_t v) {
        if (v >= mesh_.points()) return static_cast<std::int32_t>(families + v - mesh_.points()) + 1;
        return of_nodes.of[v] == kNone ? 0 : static_cast<std::int32_t>(of_nodes.of[v]) + 1;
      });
    }
    file_.group(kFamilies + "/ELEME");
  }

  std::vector<std::string> names_of(const std::vector<std::uint32_t>& parts) const {
    std::vector<std::string> names;
    for (const std::uint32_t p : parts) names.push_back(names_[p]);
    return names;
  }

  void write_family(const std::string& group, std::int32_t number, const std::vector<std::string>& names) {
    // Names of families must not have the "/" of HDF5's paths.
    const std::string family = group + fmt::format("/FAM_{}", number);
    file_.group(family);
    file_.attribute(family, "NUM", number);
    file_.group(family + "/GRO");
    file_.attribute(family + "/GRO", "NBR", static_cast<std::int32_t>(names.size()));
    file_.texts(family + "/GRO/NOM", names, kLongestGroup);
  }

  /// The families of a kind of element, and the number of the first one; they count downward.
  struct Families {
    Combinations of;
    std::int32_t first;
    std::int32_t at(std::size_t element) const { return first - static_cast<std::int32_t>(of.of[element]); }
  };
  Families families_of(Kind kind) {
    Families families{combinations(mesh_, kind), next_family_};
    for (const auto& parts : families.of.parts) write_family(kFamilies + "/ELEME", next_family_--, names_of(parts));
    return families;
  }

  void write_solids() {
    const Families families = families_of(Kind::kElements);
    for (const MixedCells::Kind kind : MixedCells::kAllKinds) {
      const std::size_t begin = cells_.begin(kind);
      write_cells(
          kMedSolids[kind], cells_.end(kind) - begin, cells_.nodes_per(kind),
          [&](std::uint64_t i, std::uint64_t k) {
            return kind == MixedCells::kTet ? cells_.node(i, kMedTet[k]) : cells_.node(begin + i, k, kMedWide);
          },
          [&](std::uint64_t i) { return families.at(cells_.first_tet(begin + i)); });
    }
  }

  void write_faces() {
    const Families families = families_of(Kind::kFaces);
    const auto write_those = [&](const MedSection& type, std::size_t begin, std::size_t end, std::uint64_t nodes) {
      write_cells(
          type, end - begin, nodes, [&](std::uint64_t i, std::uint64_t k) { return cells_.face_node(begin + i, k); },
          [&](std::uint64_t i) { return families.at(cells_.first_face(begin + i)); });
    };
    write_those(kMedTriangles, 0, cells_.triangles(), mesh_.nodes_per_face());
    write_those(kMedQuads, cells_.triangles(), cells_.faces(), cells_.nodes_per_quad());
  }

  void write_edges() {
    const Families families = families_of(Kind::kEdges);
    write_cells(
        kMedEdges, mesh_.edges(), mesh_.nodes_per_edge(),
        [&](std::uint64_t i, std::uint64_t k) { return mesh_.edge_node(i, k); },
        [&](std::uint64_t i) { return families.at(i); });
  }

  /// So many cells of a kind: their nodes, node_at(i, k), and their families.
  template <class NodeAt, class FamilyOf>
  void write_cells(const MedSection& type, std::uint64_t count, std::uint64_t nodes, const NodeAt& node_at,
                   const FamilyOf& family_of) {
    if (count == 0) return;
    const std::string cells = kStep + "/MAI/" + type.name[mesh_.second_order()];
    file_.group(cells);
    file_.attribute(cells, "CGT", 1);
    file_.attribute(cells, "CGS", 1);
    file_.attribute(cells, "GEO", type.number[mesh_.second_order()]);
    file_.attribute(cells, "PFL", "MED_NO_PROFILE_INTERNAL");
    values<std::int32_t>(cells + "/NOD", nodes, count,
                         [&](std::uint64_t k, std::uint64_t i) { return 1 + node_at(i, k); });
    values<std::int32_t>(cells + "/FAM", 1, count, [&](std::uint64_t, std::uint64_t i) { return family_of(i); });
  }

  /// What has one name: values at nodes, of elements, or both.
  struct MedField {
    std::string name;
    std::array<const MeshField*, 2> of;
    const MeshField& any() const { return of[0] != nullptr ? *of[0] : *of[1]; }
  };

  static std::vector<MedField> fields_of(MeshOutput& out) {
    // A "/" would be one of HDF5's paths.
    LegalNames names({.longest = kLongestField,
                      .also = " _-.:+#*()[]{}<>=%$&!?~^@|,;'\"",
                      .letter_first = false,
                      .ignores_case = false});
    std::vector<MedField> all;
    for (const MeshField& field : out.fields()) {
      const auto takes = [&](const MedField& f) {
        return f.of[field.of_elements] == nullptr && f.any().name == field.name &&
               f.any().components == field.components;
      };
      auto at = std::find_if(all.begin(), all.end(), takes);
      if (at == all.end()) at = all.insert(all.end(), {names.legal(field.name), {}});
      at->of[field.of_elements] = &field;
    }
    out.note(names.note());
    return all;
  }

  void write_field(const MedField& field) {
    const std::string path = "/CHA/" + field.name, step = path + kNoTime;
    const std::size_t components = field.any().components;
    file_.group(path);
    file_.attribute(path, "MAI", "mesh");
    file_.attribute(path, "NCO", static_cast<std::int32_t>(components));
    std::string names;
    for (std::size_t k = 0; k < components; ++k) names += fmt::format("{:16}", component_name(components, k));
    file_.attribute(path, "NOM", names);
    file_.attribute(path, "TYP", 6);  // doubles
    file_.attribute(path, "UNI", std::string(names.size(), ' '));
    file_.attribute(path, "UNT", "");
    file_.group(step);
    for (const char* name : {"NDT", "NOR", "RDT", "ROR"}) file_.attribute(step, name, -1);
    file_.attribute(step, "PDT", 0.0);
    if (field.of[0] != nullptr) write_values(step + "/NOE", *field.of[0], 0, mesh_.points());
    for (const MixedCells::Kind kind : MixedCells::kAllKinds)
      if (field.of[1] != nullptr && cells_.end(kind) > cells_.begin(kind))
        write_values(step + "/MAI." + kMedSolids[kind].name[mesh_.second_order()], *field.of[1], cells_.begin(kind),
                     cells_.end(kind));
  }

  /// One value for each of a kind of elements.
  void write_values(const std::string& path, const MeshField& field, std::size_t begin, std::size_t end) {
    const std::string profile = path + "/MED_NO_PROFILE_INTERNAL";
    file_.group(path);
    file_.attribute(path, "GAU", "");
    file_.attribute(path, "PFL", "MED_NO_PROFILE_INTERNAL");
    file_.group(profile);
    file_.attribute(profile, "GAU", "");
    file_.attribute(profile, "NBR", static_cast<std::int32_t>(end - begin));
    file_.attribute(profile, "NGA", 1);
    const std::uint64_t count = end - begin;
    file_.values<double>(profile + "/CO", {count * field.components},
                         [&](std::uint64_t i) { return cells_.value_of(field, begin + i % count, i / count); });
  }

  Hdf5Writer file_;
  const MeshParts& mesh_;
  MixedCells cells_;
  std::vector<MedField> fields_;
  ShortNames groups_{kLongestGroup};
  std::vector<std::string> names_;  ///< of the groups that parts are
  std::vector<AsterNames::Point> points_;
  std::int32_t next_family_ = -1;
};

}  // namespace

void write_med(MeshOutput& out, const MeshParts& mesh) {
  out.require_32_bits(std::max(mesh.points(), mesh.tets()),
                      "MED files have 32-bit numbers, too few for this mesh; write .vtu");
  if (out.job() == nullptr) return MedWriter(out, mesh, nullptr).write();
  const AsterNames names = aster_names(out, mesh, *out.job());
  if (!names.points.empty() && !out.fields().empty())
    throw OptionError("`couple`: reference points have no values of fields; write them to another file");
  MedWriter(out, mesh, &names).write();
  write_aster_job(out, mesh, *out.job(), names);
}

}  // namespace octafront::io
