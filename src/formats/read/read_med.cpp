// MED 3 and 4: nodes, tetrahedra, wedges, pyramids, faces and edges of the first mesh at its first step; groups by
// their families; of fields the last step, of values at nodes and one for each element. See write_med.cpp for the order
// of nodes.

#include "formats/containers/hdf5_file.h"
#include "formats/parts/raw_mesh.h"
#include "formats/parts/wide_orders.h"
#include "formats/read/readers.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include <fmt/core.h>

namespace octafront::io {
namespace {

using Kind = NamedSet::Kind;

struct MedCell {
  std::string_view name;
  Kind kind;
  std::size_t nodes;
  std::array<std::uint8_t, 27> order;  ///< places of our nodes in MED's list
};
template <std::size_t N>
constexpr std::array<std::uint8_t, 27> widened(const std::array<std::uint8_t, N>& places) {
  std::array<std::uint8_t, 27> order{};
  for (std::size_t k = 0; k < N; ++k) order[k] = places[k];
  return order;
}
/// The corners; nodes behind them are not asked for.
constexpr std::array<std::uint8_t, 27> of_hexahedron() {
  std::array<std::uint8_t, 27> order{0, 3, 2, 1, 4, 7, 6, 5};
  for (std::uint8_t k = 8; k < 27; ++k) order[k] = k;
  return order;
}
constexpr std::array kMedCells{MedCell{"TE4", Kind::kElements, 4, {0, 2, 1, 3}},
                               MedCell{"T10", Kind::kElements, 10, {0, 2, 1, 3, 6, 5, 4, 7, 9, 8}},
                               MedCell{"PE6", Kind::kElements, 6, widened(kMedWide.wedge)},
                               MedCell{"P15", Kind::kElements, 15, widened(kMedWide.wedge)},
                               MedCell{"PY5", Kind::kElements, 5, widened(kMedWide.pyramid)},
                               MedCell{"P13", Kind::kElements, 13, widened(kMedWide.pyramid)},
                               MedCell{"HE8", Kind::kElements, 8, of_hexahedron()},
                               MedCell{"H20", Kind::kElements, 20, of_hexahedron()},
                               MedCell{"H27", Kind::kElements, 27, of_hexahedron()},
                               MedCell{"QU4", Kind::kFaces, 4, {0, 1, 2, 3}},
                               MedCell{"QU8", Kind::kFaces, 8, {0, 1, 2, 3, 4, 5, 6, 7}},
                               MedCell{"TR3", Kind::kFaces, 3, {0, 1, 2}},
                               MedCell{"TR6", Kind::kFaces, 6, {0, 1, 2, 3, 4, 5}},
                               MedCell{"SE2", Kind::kEdges, 2, {0, 1}},
                               MedCell{"SE3", Kind::kEdges, 3, {0, 1, 2}}};

class Med {
 public:
  explicit Med(const Input& input) : input_(input), file_(input.name, input.name, input.context) {
    raw_.format = "MED";
  }

  RawMesh read() {
    const auto meshes = file_.members("/ENS_MAA");
    if (meshes.empty()) file_.fail("is an HDF5 file, but no MED mesh (it has no /ENS_MAA)");
    if (meshes.size() > 1) raw_.notes.push_back(fmt::format("of {} meshes the first was read", meshes.size()));
    mesh_ = "/ENS_MAA/" + meshes[0];
    const auto steps = file_.members(mesh_);
    if (steps.empty()) file_.fail("has a mesh without any step; the file is damaged");
    // Before MED 3 a mesh has no steps, and its families are its own.
    const bool is_old = file_.has(mesh_ + "/NOE/COO");
    step_ = is_old ? mesh_ : mesh_ + "/" + steps[0];
    families_ = is_old ? mesh_ + "/FAS" : "/FAS/" + meshes[0];
    read_nodes();
    read_families();
    if (input_.field != nullptr) read_fields();
    for (const std::string& type : file_.members(step_ + "/MAI")) read_cells(type);
    make_groups();
    return std::move(raw_);
  }

 private:
  using Groups = std::map<std::pair<std::string, Kind>, std::vector<std::uint32_t>>;

  void read_nodes() {
    const std::vector<double> xyz = file_.reals(step_ + "/NOE/COO");
    const std::size_t n = xyz.size() / 3;
    if (const std::int64_t nodes = file_.integer_attribute(step_ + "/NOE/COO", "NBR");
        xyz.size() % 3 != 0 || n >= kNone || static_cast<std::uint64_t>(nodes) != n)
      file_.fail(fmt::format("has {} coordinates of {} nodes: it is of another dimension than 3", xyz.size(), nodes));
    for (std::size_t v = 0; v < n; ++v) {
      const Vec3 p{xyz[v], xyz[n + v], xyz[2 * n + v]};
      if (!is_finite(p)) file_.fail(fmt::format("node {} is ({}, {}, {}), which is no place", v + 1, p.x, p.y, p.z));
      raw_.points.push_back(p);
    }
  }

  /// The groups of each family; those of nodes are positive, those of elements negative.
  void read_families() {
    constexpr std::size_t kLength = 80;
    for (const char* kind : {"/NOEUD", "/ELEME"})
      for (const std::string& family : file_.members(families_ + kind)) {
        const std::string path = families_ + kind + "/" + family;
        if (!file_.has(path + "/GRO/NOM")) continue;
        const std::string names = file_.bytes(path + "/GRO/NOM");
        std::vector<std::string>& groups = groups_of_family_[file_.integer_attribute(path, "NUM")];
        for (std::size_t at = 0; at + kLength <= names.size(); at += kLength) {
          std::string name = names.substr(at, kLength);
          name.resize(std::min(name.size(), name.find('\0')));
          while (!name.empty() && name.back() == ' ') name.pop_back();
          groups.push_back(std::move(name));
        }
      }
    // From -1 downward, as they were numbered: alphabetical order puts -10 before -2.
    for (auto family = groups_of_family_.rbegin(); family != groups_of_family_.rend(); ++family)
      for (const std::string& name : family->second)
        if (std::find(order_.begin(), order_.end(), name) == order_.end()) order_.push_back(name);
    if (!file_.has(step_ + "/NOE/FAM")) return;
    const std::vector<std::int64_t> of = file_.integers(step_ + "/NOE/FAM");
    for (std::uint32_t v = 0; v < std::min(of.size(), raw_.points.size()); ++v) add_to_groups(of[v], Kind::kNodes, v);
  }

  /// Offers all fields; of the one that is asked for the values at nodes, and where those of elements are.
  void read_fields() {
    if (!file_.has("/CHA")) return;
    for (const std::string& name : file_.members("/CHA")) {
      const std::string path = "/CHA/" + name;
      const auto steps = file_.members(path);
      const std::int64_t components = file_.integer_attribute(path, "NCO");
      if (steps.empty() || components < 1) continue;
      if (!raw_.field.offer(input_, name, static_cast<std::uint64_t>(components))) continue;
      const std::string step = path + "/" + steps.back();
      const auto each = static_cast<std::size_t>(components);
      raw_.field.at_points = values_of_field(step + "/NOE", raw_.points.size(), each);
      const auto places = file_.members(step);
      if (each == 1 && std::any_of(places.begin(), places.end(), [](const auto& p) { return p.starts_with("MAI."); }))
        field_ = step;
    }
  }

  /// In the order of ours; empty where the file has others than so many for each.
  std::vector<double> values_of_field(const std::string& place, std::size_t count, std::size_t each) const {
    const std::string path = place + "/MED_NO_PROFILE_INTERNAL/CO";
    if (!file_.has(path)) return {};
    const std::vector<double> columns = file_.reals(path);
    if (columns.size() != count * each) return {};
    std::vector<double> values(columns.size());
    for (std::size_t i = 0; i < columns.size(); ++i) values[i % count * each + i / count] = columns[i];
    return values;
  }

  void add_to_groups(std::int64_t family, Kind kind, std::uint32_t member) {
    const auto found = groups_of_family_.find(family);
    if (found == groups_of_family_.end()) return;
    for (const std::string& name : found->second) members_[{name, kind}].push_back(member);
  }

  void read_cells(const std::string& name) {
    const std::string path = step_ + "/MAI/" + name;
    const auto type =
        std::find_if(kMedCells.begin(), kMedCells.end(), [&](const MedCell& t) { return t.name == name; });
    if (!file_.has(path + "/NOD")) return;
    const std::vector<std::int64_t> nodes = file_.integers(path + "/NOD");
    if (type == kMedCells.end()) {
      // Of polyhedra and the like the number of nodes is not known: what counts is that they are told.
      if (name != "PO1")
        raw_.other_elements +=
            nodes.empty() ? 0 : static_cast<std::uint64_t>(file_.integer_attribute(path + "/NOD", "NBR"));
      return;
    }
    const std::size_t count = nodes.size() / type->nodes;
    if (nodes.size() % type->nodes != 0) file_.fail(fmt::format("{} is no multiple of {}", path, type->nodes));
    std::vector<std::int64_t> family;
    if (file_.has(path + "/FAM")) family = file_.integers(path + "/FAM");
    std::vector<double> values;
    if (!field_.empty()) values = values_of_field(field_ + "/MAI." + name, count, 1);
    std::array<VertexIndex, 27> all;
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t k = 0; k < type->nodes; ++k) {
        const std::int64_t v = nodes[k * count + i];
        if (v < 1 || static_cast<std::uint64_t>(v) > raw_.points.size())
          file_.fail(fmt::format("an element has the node {} of {}; the file is damaged: export it again", v,
                                 raw_.points.size()));
        all[type->order[k]] = static_cast<VertexIndex>(v - 1);
      }
      const auto [first, last] = add(type->kind, std::span(all).first(type->nodes));
      for (std::uint32_t member = first; i < family.size() && member < last; ++member)
        add_to_groups(family[i], type->kind, member);
      // Who asks for the field is told that some have no value.
      if (!field_.empty()) raw_.field.take(values.empty() ? std::nan("") : values[i], raw_);
    }
  }

  /// What a cell becomes: a range of tetrahedra, triangles or edges.
  std::pair<std::uint32_t, std::uint32_t> add(Kind kind, std::span<const VertexIndex> nodes) {
    const auto size = [&] {
      return static_cast<std::uint32_t>(kind == Kind::kElements ? raw_.tets.size()
                                        : kind == Kind::kFaces  ? raw_.triangles.size()
                                                                : raw_.edges.size());
    };
    const std::uint32_t first = size();
    if (kind == Kind::kFaces) {
      raw_.add_face(nodes, 0);
    } else if (kind == Kind::kEdges) {
      raw_.edges.push_back({nodes[0], nodes[1]});
    } else if (nodes.size() == 4 || nodes.size() == 10) {
      raw_.add_tet(nodes, 0);
    } else if (nodes.size() == 8 || nodes.size() >= 20) {
      raw_.add_hexahedron(nodes, 0);
    } else {
      raw_.add_wide_cell(nodes, 0);
    }
    return {first, size()};
  }

  /// Groups are in the order in which families name them.
  void make_groups() {
    raw_.tet_ref.clear();
    raw_.triangle_ref.clear();
    for (const std::string& name : order_)
      for (const Kind kind : {Kind::kElements, Kind::kFaces, Kind::kEdges, Kind::kNodes})
        if (const auto found = members_.find({name, kind}); found != members_.end())
          raw_.groups.push_back({name, kind, std::move(found->second)});
  }

  const Input& input_;
  Hdf5Reader file_;
  RawMesh raw_;
  std::string mesh_, step_, families_;
  std::string field_;  ///< the step of the field whose values of elements are asked for; empty: none
  std::map<std::int64_t, std::vector<std::string>> groups_of_family_;
  std::vector<std::string> order_;  ///< names of groups as they are first named
  Groups members_;
};

}  // namespace

RawMesh read_med(const Input& input) {
  return Med(input).read();
}

}  // namespace octafront::io
