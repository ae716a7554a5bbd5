// Abaqus and CalculiX input: nodes, elements, sets. A region is the ELSET of its elements, a patch a SURFACE of element
// sides and the NSET of its nodes, a curve the NSET of its nodes. To be included into a deck that has materials,
// sections and steps. CalculiX reads twenty characters of a number.

#include "formats/containers/text_writer.h"
#include "formats/parts/mixed_cells.h"
#include "formats/write/writers.h"

#include <algorithm>
#include <array>
#include <span>
#include <string>

namespace octafront::io {
namespace {

using Kind = NamedSet::Kind;

/// Sides S1 = 123, S2 = 124, S3 = 234, S4 = 134, by the corner that they lack.
constexpr std::array<char, 4> kSideName{'3', '4', '2', '1'};
/// The side of a wedge or pyramid that has all these nodes.
char side_of(const WideCell& cell, std::span<const VertexIndex> nodes) {
  const auto& sides = cell.tet_count == 3 ? kWedgeFaces : kPyramidFaces;
  for (std::size_t s = 0; s < sides.size(); ++s) {
    const auto has = [&](VertexIndex v) {
      return std::ranges::any_of(sides[s], [&](std::size_t k) { return cell.nodes[k] == v; });
    };
    if (std::ranges::all_of(nodes, has)) return static_cast<char>('1' + s);
  }
  return '1';
}

class AbaqusWriter {
 public:
  AbaqusWriter(MeshOutput& out, const MeshParts& mesh)
      : text_(out.file()), mesh_(mesh), cells_(mesh), names_(legal_names(out, mesh, {.longest = 64})) {}

  void write() {
    text_ << "*HEADING\nMesh by octafront\n";
    for (std::size_t p = 0; p < names_.size(); ++p)
      if (names_[p] != mesh_.parts()[p].name)
        text_.line("** NAME {} IS \"{}\"", names_[p], one_line(mesh_.parts()[p].name));
    text_ << "*NODE\n";
    for (std::uint32_t v = 0; v < mesh_.points(); ++v) {
      text_ << v + 1;
      for (int axis = 0; axis < 3; ++axis) (text_ << ", ").within(20, mesh_.mesh().points[v][axis]);
      text_ << '\n';
    }
    for (std::size_t p = 0; p < names_.size(); ++p) {
      const Part& part = mesh_.parts()[p];
      if (part.origin == Part::Origin::kRegion) write_elements(part, names_[p]);
    }
    for (std::size_t p = 0; p < names_.size(); ++p)
      if (mesh_.parts()[p].origin != Part::Origin::kRegion) write_set(mesh_.parts()[p], names_[p]);
  }

 private:
  void write_elements(const Part& region, const std::string& name) {
    const std::array<const char*, MixedCells::kKinds> types{mesh_.second_order() ? "C3D10" : "C3D4", "C3D5", "C3D6"};
    std::array<VertexIndex, 10> room;
    std::size_t kind = MixedCells::kKinds;
    for (const std::uint32_t cell : cells_.members(region)) {
      if (cells_.kind(cell) != kind) {
        kind = cells_.kind(cell);
        text_.line("*ELEMENT, TYPE={}, ELSET={}", types[kind], name);
      }
      text_ << cell + 1;
      for (const VertexIndex v : cells_.nodes(cell, room)) text_ << ", " << v + 1;
      text_ << '\n';
    }
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
    std::array<VertexIndex, 6> room;
    for (const std::uint32_t f : cells_.members(part)) {
      const Side& side = mesh_.sides()[cells_.first_face(f)];
      const std::size_t cell = cells_.cell_of(side.tet);
      const bool is_tet = cells_.kind(cell) == MixedCells::kTet;
      text_ << cell + 1 << ", S"
            << (is_tet ? kSideName[static_cast<std::size_t>(side.face)]
                       : side_of(cells_.wide(cell), cells_.face_nodes(f, room)))
            << '\n';
    }
  }

  TextWriter text_;
  const MeshParts& mesh_;
  MixedCells cells_;
  std::vector<std::string> names_;  ///< of the parts
};

}  // namespace

void write_abaqus(MeshOutput& out, const MeshParts& mesh) {
  const auto& wide = mesh.mesh().wide_cells;
  if (std::ranges::any_of(wide, [](const WideCell& cell) { return cell.tet_count == 2; }))
    out.note(
        "layers that end have pyramids (C3D5), which CalculiX does not know: for it write them as tetrahedra, "
        "`as_tets`");
  AbaqusWriter(out, mesh).write();
}

}  // namespace octafront::io
