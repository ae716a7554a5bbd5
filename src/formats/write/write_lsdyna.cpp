// LS-DYNA keyword file, in standard columns: a part per region, node sets, segment sets for patches, solid sets.
// Elements are ELFORM 10 (tet4) or 16 (tet10); with wedges and pyramids ELFORM 1, bricks of which some nodes are one.

#include "formats/containers/text_writer.h"
#include "formats/parts/mixed_cells.h"
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
  LsDynaWriter(MeshOutput& out, const MeshParts& mesh) : text_(out.file()), mesh_(mesh), cells_(mesh) {}

  void write() {
    text_ << "*KEYWORD\n$ Mesh by octafront: materials and what loads it are for you to add\n*TITLE\nmesh\n";
    const bool is_mixed = !mesh_.wide_cells().empty();
    if (is_mixed) text_ << "*CONTROL_SOLID\n         1\n";  // sorts degenerate bricks into ELFORM 10 and 15
    text_.line("*SECTION_SOLID\n         1{:10}", is_mixed ? 1 : mesh_.second_order() ? 16 : 10);
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
    for (std::size_t c = 0; c < cells_.cells(); ++c) write_element(c);
    std::uint64_t number = 0;
    for (const Part& part : mesh_.parts())
      if (part.origin != Part::Origin::kRegion) write_set(part, ++number);
    text_ << "*END\n";
  }

 private:
  void write_element(std::size_t c) {
    // What has four, five or six nodes is a degenerate brick; a wedge stands on a quadrilateral.
    constexpr std::array<std::array<std::uint8_t, 10>, MixedCells::kKinds> kBrick{
        {{0, 1, 2, 3, 3, 3, 3, 3, 3, 3}, {0, 1, 2, 3, 4, 4, 4, 4, 4, 4}, {1, 0, 3, 4, 2, 2, 5, 5, 5, 5}}};
    CellRoom room;
    const auto nodes = cells_.nodes(c, room);
    const std::uint32_t region = mesh_.region_of(cells_.first_tet(c));
    text_.field(8, std::uint64_t{c} + 1).field(8, std::uint64_t{mesh_.tag_of_region(region)}) << '\n';
    for (std::size_t k = 0; k < 10; ++k)
      text_.field(8, std::uint64_t{nodes[mesh_.second_order() ? k : kBrick[cells_.kind(c)][k]]} + 1);
    text_ << '\n';
  }

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
      for (const std::uint32_t f : cells_.members(part)) {
        for (const std::size_t k : {0U, 1U, 2U, f < cells_.triangles() ? 2U : 3U})
          text_.field(10, std::uint64_t{cells_.face_node(f, k)} + 1);
        text_ << '\n';
      }
      return;
    }
    const bool of_elements = part.kind == Kind::kElements;
    text_.line("{}\n{}\n{:10}", of_elements ? "*SET_SOLID_TITLE" : "*SET_NODE_LIST_TITLE", title(part), number);
    write_ids(of_elements ? cells_.members(part) : mesh_.nodes_of(part));
  }

  TextWriter text_;
  const MeshParts& mesh_;
  MixedCells cells_;
};

}  // namespace

void write_lsdyna(MeshOutput& out, const MeshParts& mesh) {
  LsDynaWriter(out, mesh).write();
}

}  // namespace octafront::io
