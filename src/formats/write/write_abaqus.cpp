// Abaqus and CalculiX input: nodes, elements, sets. A region is the ELSET of its elements, a patch a SURFACE of element
// sides and the NSET of its nodes, a curve the NSET of its nodes, what is split the ELSET NAME_cohesive of cohesive
// elements, where they are asked for. To be included into a deck that has materials, sections and steps. CalculiX reads
// twenty characters of a number.
//
// Of a periodic cell, equations tie each copy to the node that it is a copy of, and to a node of no element for each
// period: what moves that node stretches the cell. By a rotation the copy's displacement is the original's, turned.

#include <octafront/error.h>

#include "base/core/wording.h"
#include "formats/containers/text_writer.h"
#include "formats/parts/mixed_cells.h"
#include "formats/write/job_writers.h"
#include "formats/write/writers.h"

#include <algorithm>
#include <array>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace octafront::io {
namespace {

using Kind = NamedSet::Kind;

/// Sides S1 = 123, S2 = 124, S3 = 234, S4 = 134, by the corner that they lack.
constexpr std::array<char, 4> kSideName{'3', '4', '2', '1'};
constexpr std::array<int, 3> kDirections{0, 1, 2};
constexpr NameRules kAbaqusNames{.longest = 64, .one_space = true};
class AbaqusWriter {
 public:
  AbaqusWriter(MeshOutput& out, const MeshParts& mesh)
      : text_(out.file()),
        mesh_(mesh),
        cells_(mesh),
        names_(legal_names(out, mesh, kAbaqusNames)),
        number_(cells_.cells()) {
    for (const std::string& name : names_) further_.legal(name);
  }

  void write() {
    text_ << "*HEADING\nMesh by octafront\n";
    for (std::size_t p = 0; p < names_.size(); ++p)
      if (names_[p] != mesh_.parts()[p].name)
        text_.line("** NAME {} IS \"{}\"", names_[p], one_line(mesh_.parts()[p].name));
    text_ << "*NODE\n";
    for (std::uint32_t v = 0; v < mesh_.points(); ++v) write_node(v + 1, mesh_.mesh().points[v]);
    for (std::size_t p = 0; p < names_.size(); ++p) {
      const Part& part = mesh_.parts()[p];
      if (part.origin == Part::Origin::kRegion) write_elements(part, names_[p]);
    }
    for (std::size_t p = 0; p < names_.size(); ++p)
      if (mesh_.parts()[p].origin != Part::Origin::kRegion) write_set(mesh_.parts()[p], names_[p]);
    if (!mesh_.mesh().periods.empty()) write_periods();
  }

  void write_materials(const std::vector<SetMaterial>& materials, double poissons_ratio) {
    for (const SetMaterial& material : materials)
      for (std::size_t p = 0; p < names_.size(); ++p) {
        const Part& part = mesh_.parts()[p];
        if (part.origin != Part::Origin::kSet || part.kind != Kind::kElements || part.name != material.set) continue;
        text_.line("** {}: {} = {:.9g}", names_[p], one_line(material.quantity), material.value);
        if (material.quantity != "E") continue;
        text_.line("*MATERIAL, NAME={}\n*ELASTIC\n{:.9g}, {:.9g}", names_[p], material.value, poissons_ratio);
        text_.line("*SOLID SECTION, ELSET={0}, MATERIAL={0}", names_[p]);
      }
  }

  /// Of the curves in a list with commas. Throws OptionError.
  void write_beams(const std::string& list) {
    for (const std::string& name : names_listed(list, mesh_.mesh().curve_names)) write_beams_of(name);
  }

  void write_job(const JobPlan& plan, bool has_sections) {
    const AbaqusNames names{.parts = names_,
                            .more = [this](const std::string& name) { return further_.legal(name); },
                            .first_node = mesh_.points() + mesh_.mesh().periods.size() + 1};
    write_abaqus_job(text_, mesh_, plan, names, has_sections);
  }

  /// COH3D6: the triangle behind, the one in front, in the order in which wedges have theirs.
  void write_cohesive() {
    std::uint32_t patch = kNone;
    for (const SplitFace& f : mesh_.mesh().split_faces) {
      if (f.patch != patch) {
        patch = f.patch;
        std::string name = mesh_.mesh().patch_names[patch];
        name = name.substr(0, name.rfind("_plus")) + "_cohesive";
        text_.line("*ELEMENT, TYPE=COH3D6, ELSET={}", further_.legal(name));
      }
      text_ << ++number_;
      for (const VertexIndex v : f.nodes) text_ << ", " << v + 1;
      text_ << '\n';
    }
  }

 private:
  void write_beams_of(const std::string& name) {
    const auto parts = mesh_.parts(Part::Origin::kCurve);
    const auto curve = std::find_if(parts.begin(), parts.end(), [&](const Part& p) { return p.name == name; });
    if (curve == parts.end()) throw OptionError(fmt::format("no curve \"{}\" could be beams", name));
    text_.line("*ELEMENT, TYPE={}, ELSET={}", mesh_.second_order() ? "B32" : "B31", further_.legal(name + "_beams"));
    for (const std::uint32_t e : curve->members) {
      EdgeRoom room;
      const auto nodes = mesh_.edge_nodes(e, room);
      text_ << ++number_ << ", " << nodes[0] + 1;
      if (nodes.size() == 3) text_ << ", " << nodes[2] + 1;
      text_ << ", " << nodes[1] + 1 << '\n';
    }
  }

  void write_node(std::uint32_t number, Vec3 p) {
    text_ << number;
    for (int axis = 0; axis < 3; ++axis) (text_ << ", ").within(20, p[axis]);
    text_ << '\n';
  }

  std::uint32_t node_of_period(std::uint32_t period) const {
    return static_cast<std::uint32_t>(mesh_.points()) + period + 1;
  }

  void write_periods() {
    if (!mesh_.mesh().period_rotations.empty()) return write_rotations();
    const std::vector<Vec3>& periods = mesh_.mesh().periods;
    text_ << "** PERIODIC: U(COPY) - U(ORIGINAL) = U(PERIOD_1) + ..., WHICH IS THE MEAN STRAIN TIMES THE PERIOD\n";
    for (std::uint32_t k = 0; k < periods.size(); ++k) {
      text_.line("*NODE, NSET=PERIOD_{}", k + 1);
      write_node(node_of_period(k), periods[k]);
    }
    std::map<VertexIndex, std::pair<std::uint32_t, VertexIndex>> next;  // by the copy: a period and the original
    for (const auto& [period, copy, original] : mesh_.mesh().periodic_nodes)
      if (copy < mesh_.points()) next.try_emplace(copy, period, original);
    text_ << "*EQUATION\n";
    for (const auto& [copy, first] : next) {
      std::vector<std::uint32_t> others{node_of_period(first.first)};
      VertexIndex original = first.second;
      for (auto at = next.find(original); at != next.end(); at = next.find(original)) {
        others.push_back(node_of_period(at->second.first));
        original = at->second.second;
      }
      others.insert(others.begin(), original + 1);
      for (int direction = 1; direction <= 3; ++direction) write_equation(copy + 1, others, direction);
    }
  }

  void write_rotations() {
    text_ << "** CYCLIC: U(COPY) = R U(ORIGINAL)\n*EQUATION\n";
    for (const auto& [period, copy, original] : mesh_.mesh().periodic_nodes) {
      if (copy >= mesh_.points()) continue;
      for (int direction = 0; direction < 3; ++direction) {
        const Vec3 row = mesh_.mesh().period_rotations[period][static_cast<std::size_t>(direction)];
        const auto terms = std::count_if(kDirections.begin(), kDirections.end(), [&](int i) { return row[i] != 0; });
        text_.line("{}", terms + 1);
        text_ << copy + 1 << ", " << direction + 1 << ", 1.";
        for (const int i : kDirections)
          if (row[i] != 0) (text_ << ", " << original + 1 << ", " << i + 1 << ", ").within(20, -row[i]);
        text_ << '\n';
      }
    }
  }

  /// That a node moves as these others together.
  void write_equation(std::uint32_t node, const std::vector<std::uint32_t>& others, int direction) {
    constexpr std::size_t kMostInLine = 4;
    text_.line("{}", others.size() + 1);
    text_ << node << ", " << direction << ", 1.";
    for (std::size_t i = 0; i < others.size(); ++i)
      text_ << ((i + 1) % kMostInLine == 0 ? ",\n" : ", ") << others[i] << ", " << direction << ", -1.";
    text_ << '\n';
  }

  char side_name(std::size_t cell, std::uint32_t face, const Side& side) const {
    if (cells_.kind(cell) == MixedCells::kTet) return kSideName[static_cast<std::size_t>(side.face)];
    std::size_t s = cells_.side_of(cell, face);
    if (mesh_.second_order() && cells_.kind(cell) == MixedCells::kPyramid) s = kPyramidSideOfWedge[s];
    return static_cast<char>('1' + s);
  }

  void write_elements(const Part& region, const std::string& name) {
    // There are no pyramids of second order.
    const bool second = mesh_.second_order();
    const std::array<const char*, MixedCells::kKinds> types{second ? "C3D10" : "C3D4", second ? "C3D15" : "C3D5",
                                                            second ? "C3D15" : "C3D6"};
    std::size_t kind = MixedCells::kKinds;
    for (const std::uint32_t cell : cells_.members(region)) {
      if (cells_.kind(cell) != kind) {
        kind = cells_.kind(cell);
        text_.line("*ELEMENT, TYPE={}, ELSET={}", types[kind], name);
      }
      write_element(cell, second);
    }
  }

  void write_element(std::uint32_t cell, bool second) {
    CellRoom room;
    std::array<VertexIndex, 15> wedge;
    auto nodes = cells_.nodes(cell, room);
    if (second && cells_.kind(cell) == MixedCells::kPyramid) nodes = as_wedge(nodes, wedge);
    text_ << cell + 1;
    for (const VertexIndex v : nodes) text_ << ", " << v + 1;
    text_ << '\n';
  }

  void write_ids(std::span<const std::uint32_t> ids) {
    constexpr std::size_t kMostInLine = 16;
    for (std::size_t i = 0; i < ids.size(); ++i)
      text_ << ids[i] + 1 << (i + 1 == ids.size() || (i + 1) % kMostInLine == 0 ? "\n" : ", ");
  }

  void write_set(const Part& part, const std::string& name) {
    if (part.kind == Kind::kElements) {
      text_.line("*ELSET, ELSET={}", name);
      return write_ids(cells_.members(part));
    }
    text_.line("*NSET, NSET={}", name);
    write_ids(mesh_.nodes_of(part));
    if (part.kind != Kind::kFaces) return;
    text_.line("*SURFACE, NAME={}, TYPE=ELEMENT", name);
    for (const std::uint32_t f : cells_.members(part)) {
      const Side& side = mesh_.sides()[cells_.first_face(f)];
      const std::size_t cell = cells_.cell_of(side.tet);
      text_ << cell + 1 << ", S" << side_name(cell, f, side) << '\n';
    }
  }

  TextWriter text_;
  const MeshParts& mesh_;
  MixedCells cells_;
  std::vector<std::string> names_;  ///< of the parts
  std::size_t number_;              ///< of the last element
  LegalNames further_{kAbaqusNames};
};

}  // namespace

void write_abaqus(MeshOutput& out, const MeshParts& mesh) {
  if (std::ranges::any_of(mesh.wide_cells(), [](const WideCell& cell) { return cell.tet_count == 2; }))
    out.note(mesh.second_order()
                 ? "layers that end have pyramids, which are wedges (C3D15) here with one edge of no length"
                 : "layers that end have pyramids (C3D5), which CalculiX does not know: for it write them as "
                   "tetrahedra, `as_tets`");
  AbaqusWriter writer(out, mesh);
  writer.write();
  writer.write_materials(out.options().materials, out.options().poissons_ratio);
  writer.write_beams(out.options().beams);
  if (out.options().cohesive && mesh.second_order())
    out.note("cohesive elements are linear (COH3D6): the mid-side nodes of the two sides stay free of each other");
  if (out.options().cohesive) writer.write_cohesive();
  if (out.job() != nullptr) writer.write_job(*out.job(), !out.options().materials.empty());
}

}  // namespace octafront::io
