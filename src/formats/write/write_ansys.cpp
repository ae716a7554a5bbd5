// Ansys archive (.cdb): NBLOCK, EBLOCK, and a component (CMBLOCK) of elements per region and set of elements, of nodes
// for every other part. Tetrahedra are SOLID187, or SOLID285 if linear, wedges and
// pyramids SOLID186 or SOLID185, bricks of which some nodes are one; their material is the region, counted from 1.

#include "formats/containers/text_writer.h"
#include "formats/parts/mixed_cells.h"
#include "formats/write/job_writers.h"
#include "formats/write/writers.h"

#include <array>
#include <string>

namespace octafront::io {
namespace {

using Kind = NamedSet::Kind;

constexpr std::size_t kLongestName = 32;

/// Nodes of a brick I J K L M N O P and its mid-side nodes Q R S T U V W X Y Z A B, as those of a wedge (K and L, O and
/// P are one) or of a pyramid (M to P are one), in the order of kPlainWide.
constexpr std::array<std::uint8_t, 20> kWedgeBrick{0, 1, 2, 2, 3, 4, 5, 5, 6, 7, 2, 8, 9, 10, 5, 11, 12, 13, 14, 14};
constexpr std::array<std::uint8_t, 20> kPyramidBrick{0, 1, 2, 3, 4, 4, 4, 4, 5, 6, 7, 8, 4, 4, 4, 4, 9, 10, 11, 12};

class AnsysWriter {
 public:
  AnsysWriter(MeshOutput& out, const MeshParts& mesh)
      : text_(out.file()),
        mesh_(mesh),
        cells_(mesh),
        names_(legal_names(out, mesh, {.longest = kLongestName, .also = "_", .upper_case = true})),
        job_(out.job()) {}

  void write() {
    text_ << (job_ != nullptr ? "/COM,Job by octafront\n"
                              : "/COM,Mesh by octafront: materials and what loads it are for you to add\n")
          << "/PREP7\n";
    for (std::size_t p = 0; p < names_.size(); ++p)
      text_.line("/COM,NAME {} IS \"{}\"", names_[p], one_line(mesh_.parts()[p].name));
    text_.line("ET,1,{}", mesh_.second_order() ? 187 : 285);
    if (!mesh_.wide_cells().empty()) text_.line("ET,2,{}", mesh_.second_order() ? 186 : 185);
    text_.line("NBLOCK,6,SOLID,{0:10},{0:10}\n(3i10,6e25.16e3)", mesh_.points());
    for (std::size_t v = 0; v < mesh_.points(); ++v) {
      const Vec3 p = mesh_.mesh().points[v];
      text_.field(10, std::uint64_t{v} + 1) << "         0         0";
      text_.line("{}{}{}", real(p.x), real(p.y), real(p.z));
    }
    text_.line("N,R5.3,LOC,       -1,\nEBLOCK,19,SOLID,{0:10},{0:10}\n(19i10)", cells_.cells());
    for (std::size_t c = 0; c < cells_.cells(); ++c) write_element(c);
    text_ << "        -1\n";
    for (std::size_t p = 0; p < names_.size(); ++p) write_component(mesh_.parts()[p], names_[p]);
    if (job_ != nullptr) write_ansys_job(text_, mesh_, cells_, *job_, names_);
    text_ << "FINISH\n";
  }

 private:
  /// Three digits of exponent, as the format line says.
  static std::string real(double value) {
    const std::string text = fmt::format("{:.16E}", value);
    const std::size_t digits = text.find('E') + 2;  // behind the sign of the exponent
    return fmt::format("{:>25}", fmt::format("{}{:0>3}", text.substr(0, digits), text.substr(digits)));
  }

  std::vector<VertexIndex> nodes_of(std::size_t c) const {
    CellRoom room;
    const auto own = cells_.nodes(c, room);
    if (cells_.kind(c) == MixedCells::kTet) return {own.begin(), own.end()};
    const auto& brick = cells_.kind(c) == MixedCells::kWedge ? kWedgeBrick : kPyramidBrick;
    std::vector<VertexIndex> nodes;
    for (std::size_t k = 0; k < (mesh_.second_order() ? brick.size() : 8); ++k) nodes.push_back(own[brick[k]]);
    return nodes;
  }

  void write_element(std::size_t c) {
    const std::vector<VertexIndex> nodes = nodes_of(c);
    const std::uint64_t region = mesh_.region_of(cells_.first_tet(c)) + 1, count = nodes.size(),
                        type = cells_.kind(c) == MixedCells::kTet ? 1 : 2;
    // Material, type, real constants, section, coordinate system, death, solid model, shape, nodes, not used, number.
    for (const std::uint64_t n : {region, type, std::uint64_t{1}, std::uint64_t{1}, std::uint64_t{0}, std::uint64_t{0},
                                  std::uint64_t{0}, std::uint64_t{0}, count, std::uint64_t{0}, std::uint64_t{c} + 1})
      text_.field(10, n);
    constexpr std::size_t kInFirstLine = 8, kInLine = 19;
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      if (k == kInFirstLine || (k > kInFirstLine && (k - kInFirstLine) % kInLine == 0)) text_ << '\n';
      text_.field(10, std::uint64_t{nodes[k]} + 1);
    }
    text_ << '\n';
  }

  void write_component(const Part& part, const std::string& name) {
    const bool of_elements = part.kind == Kind::kElements;
    const std::vector<std::uint32_t> members = of_elements ? cells_.members(part) : mesh_.nodes_of(part);
    // The end of a run of numbers is negative.
    std::vector<std::int64_t> items;
    for (std::size_t i = 0, j = 0; i < members.size(); i = j) {
      while (j < members.size() && members[j] == members[i] + (j - i)) ++j;
      items.push_back(std::int64_t{members[i]} + 1);
      if (j - i > 1) items.push_back(-(std::int64_t{members[j - 1]} + 1));
    }
    if (items.empty()) return;
    text_.line("CMBLOCK,{:<8},{},{:10}\n(8i10)", name, of_elements ? "ELEM" : "NODE", items.size());
    constexpr std::size_t kInLine = 8;
    for (std::size_t i = 0; i < items.size(); ++i) {
      text_ << fmt::format("{:10}", items[i]);
      if (i % kInLine == kInLine - 1 || i + 1 == items.size()) text_ << '\n';
    }
  }

  TextWriter text_;
  const MeshParts& mesh_;
  MixedCells cells_;
  std::vector<std::string> names_;
  const JobPlan* job_;  ///< null: the mesh alone
};

}  // namespace

void write_ansys(MeshOutput& out, const MeshParts& mesh) {
  AnsysWriter(out, mesh).write();
}

}  // namespace octafront::io
