// LS-DYNA keyword file, in standard columns: a part per region, node sets, segment sets for patches, solid sets.
// Elements are ELFORM 10 (tet4) or 16 (tet10).

#include "formats/containers/text_writer.h"
#include "formats/write/writers.h"

#include <array>
#include <span>
#include <string>

namespace octafront::io {
namespace {

using Kind = NamedSet::Kind;

constexpr std::size_t kLongestTitle = 80;

class LsDynaWriter {
 public:
  LsDynaWriter(MeshOutput& out, const MeshParts& mesh) : text_(out.file()), mesh_(mesh) {}

  void write() {
    text_ << "*KEYWORD\n$ Mesh by octafront: materials and what loads it are for you to add\n*TITLE\nmesh\n";
    text_.line("*SECTION_SOLID\n         1{:10}", mesh_.second_order() ? 16 : 10);
    for (const Part& region : mesh_.parts(Part::Origin::kRegion))
      text_.line("*PART\n{}\n{:10}         1{:10}", title(region), region.tag, region.tag);
    text_ << "*NODE\n";
    for (std::size_t v = 0; v < mesh_.points(); ++v) {
      text_.field(8, std::uint64_t{v} + 1);
      for (int axis = 0; axis < 3; ++axis) text_.field(16, mesh_.mesh().points[v][axis]);
      text_ << "       0       0\n";
    }
    // Two lines: with ten nodes there is no room in one.
    text_ << "*ELEMENT_SOLID\n";
    std::array<VertexIndex, 10> room;
    for (std::size_t t = 0; t < mesh_.tets(); ++t) {
      text_.field(8, std::uint64_t{t} + 1).field(8, std::uint64_t{mesh_.tag_of_region(mesh_.region_of(t))}) << '\n';
      const auto nodes = mesh_.tet_nodes(t, room);
      // A tetrahedron of four nodes is a degenerate brick: the last one again.
      for (std::size_t k = 0; k < room.size(); ++k) text_.field(8, std::uint64_t{nodes[k < nodes.size() ? k : 3]} + 1);
      text_ << '\n';
    }
    std::uint64_t number = 0;
    for (const Part& part : mesh_.parts())
      if (part.origin != Part::Origin::kRegion) write_set(part, ++number);
    text_ << "*END\n";
  }

 private:
  static std::string title(const Part& part) { return one_line(part.name).substr(0, kLongestTitle); }

  void write_ids(std::span<const std::uint32_t> ids) {
    constexpr std::size_t kInLine = 8;
    for (std::size_t i = 0; i < ids.size(); ++i) {
      text_.field(10, std::uint64_t{ids[i]} + 1);
      if (i % kInLine == kInLine - 1 || i + 1 == ids.size()) text_ << '\n';
    }
  }

  void write_set(const Part& part, std::uint64_t number) {
    if (part.kind == Kind::kFaces) {
      text_.line("*SET_SEGMENT_TITLE\n{}\n{:10}", title(part), number);
      for (const std::uint32_t f : part.members) {
        const auto& [a, b, c] = mesh_.face(f);
        for (const VertexIndex v : {a, b, c, c}) text_.field(10, std::uint64_t{v} + 1);
        text_ << '\n';
      }
      return;
    }
    const bool of_elements = part.kind == Kind::kElements;
    text_.line("{}\n{}\n{:10}", of_elements ? "*SET_SOLID_TITLE" : "*SET_NODE_LIST_TITLE", title(part), number);
    of_elements ? write_ids(part.members) : write_ids(mesh_.nodes_of(part));
  }

  TextWriter text_;
  const MeshParts& mesh_;
};

}  // namespace

void write_lsdyna(MeshOutput& out, const MeshParts& mesh) {
  LsDynaWriter(out, mesh).write();
}

}  // namespace octafront::io
