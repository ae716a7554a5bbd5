// Abaqus and CalculiX input: nodes, elements, sets. A region is the ELSET of its elements, a patch a SURFACE of element
// sides and the NSET of its nodes, a curve the NSET of its nodes. To be included into a deck that has materials,
// sections and steps. CalculiX reads twenty characters of a number.

#include "formats/containers/text_writer.h"
#include "formats/write/writers.h"

#include <array>
#include <span>
#include <string>

namespace octafront::io {
namespace {

using Kind = NamedSet::Kind;

/// Sides S1 = 123, S2 = 124, S3 = 234, S4 = 134, by the corner that they lack.
constexpr std::array<char, 4> kSideName{'3', '4', '2', '1'};

class AbaqusWriter {
 public:
  AbaqusWriter(MeshOutput& out, const MeshParts& mesh)
      : text_(out.file()), mesh_(mesh), names_(legal_names(out, mesh, {.longest = 64})) {}

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
    text_.line("*ELEMENT, TYPE={}, ELSET={}", mesh_.second_order() ? "C3D10" : "C3D4", name);
    std::array<VertexIndex, 10> room;
    for (const TetIndex t : region.members) {
      text_ << t + 1;
      for (const VertexIndex v : mesh_.tet_nodes(t, room)) text_ << ", " << v + 1;
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
      return write_ids(part.members);
    }
    text_.line("*NSET, NSET={}", name);
    write_ids(mesh_.nodes_of(part));
    if (part.kind != Kind::kFaces) return;
    text_.line("*SURFACE, NAME={}, TYPE=ELEMENT", name);
    for (const std::uint32_t f : part.members) {
      const Side& side = mesh_.sides()[f];
      text_ << side.tet + 1 << ", S" << kSideName[static_cast<std::size_t>(side.face)] << '\n';
    }
  }

  TextWriter text_;
  const MeshParts& mesh_;
  std::vector<std::string> names_;  ///< of the parts
};

}  // namespace

void write_abaqus(MeshOutput& out, const MeshParts& mesh) {
  AbaqusWriter(out, mesh).write();
}

}  // namespace octafront::io
