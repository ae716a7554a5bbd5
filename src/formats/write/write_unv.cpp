// I-deas universal file: datasets 2411 (nodes), 2412 (elements), 2467 and 2477 (groups). Every part is a group of
// elements or of nodes; the physical property of an element is its region, patch or curve, counted from 1. Mid-side
// nodes stand between the corners. There are no pyramids: they are wedges with one edge of no length.
//
// All groups stand in 2477, which Gmsh reads; those that ideasUnvToFoam can make patches and zones of also in 2467,
// which it reads. It ends at any others there, looks for the numbers of members in a list that ends with the last
// tetrahedron (so these come last), and knows no beams (so edges are rods).

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

constexpr std::string_view kDelimiter = "    -1\n";

/// Places of VTK's nodes in a list of the format.
constexpr std::array<std::uint8_t, 10> kUnvTet10{0, 4, 1, 5, 2, 6, 7, 8, 9, 3};
constexpr std::array<std::uint8_t, 6> kUnvTriangle6{0, 3, 1, 4, 2, 5};
constexpr std::array<std::uint8_t, 8> kUnvQuad8{0, 4, 1, 5, 2, 6, 3, 7};
constexpr std::array<std::uint8_t, 3> kUnvBeam3{0, 2, 1};

/// Others end a name at the first blank.
constexpr NameRules kUnvNames{
    .longest = 40, .also = "_-.:+<>&\"'()[]{}/*=#%$!?@~^|,;", .letter_first = false, .ignores_case = false};

class UnvWriter {
 public:
  UnvWriter(MeshOutput& out, const MeshParts& mesh)
      : text_(out.file()), mesh_(mesh), cells_(mesh), names_(legal_names(out, mesh, kUnvNames)) {}

  void write() {
    open(2411);
    for (std::uint64_t v = 0; v < mesh_.points(); ++v) {
      text_.field(10, v + 1).field(10, one).field(10, one).field(10, std::uint64_t{11}) << '\n';
      const Vec3 p = mesh_.mesh().points[v];
      // The letter D is what Fortran reads as a double.
      text_.line("{}{}{}", real(p.x), real(p.y), real(p.z));
    }
    text_ << kDelimiter;
    open(2412);
    const bool second = mesh_.second_order();
    for (std::size_t e = 0; e < mesh_.edges(); ++e) {
      head(first_edge() + e, second ? 24 : 11, mesh_.curve_of(e), mesh_.nodes_per_edge());
      text_ << "         0         1         1\n";
      nodes(mesh_.edge_nodes(e, edge_), kUnvBeam3);
    }
    for (std::size_t f = 0; f < cells_.faces(); ++f) {
      const bool is_quad = f >= cells_.triangles();
      const auto all = cells_.face_nodes(f, face_);
      head(first_face() + f, std::uint64_t{is_quad ? 94U : 91U} + second, mesh_.patch_of(cells_.first_face(f)),
           all.size());
      is_quad ? nodes(all, kUnvQuad8) : nodes(all, kUnvTriangle6);
    }
    for (std::size_t c = 0; c < cells_.cells(); ++c) write_solid(c);
    text_ << kDelimiter;
    write_groups(2467, [this](const Part& part) { return is_patch_or_zone(part); });
    write_groups(2477, [](const Part&) { return true; });
  }

 private:
  static constexpr std::uint64_t one = 1;

  void write_solid(std::size_t c) {
    const bool is_tet = cells_.kind(c) == MixedCells::kTet, second = mesh_.second_order();
    std::array<VertexIndex, 15> wedge;
    auto all = cells_.nodes(c, solid_);
    if (cells_.kind(c) == MixedCells::kPyramid) all = as_wedge(all, wedge);
    const int type = is_tet ? (second ? 118 : 111) : second ? 113 : 112;
    head(first_tet() + c, static_cast<std::uint64_t>(type), mesh_.region_of(cells_.first_tet(c)), all.size());
    is_tet ? nodes(all, kUnvTet10) : nodes(all, kUnvWide.wedge);
  }

  std::uint64_t first_edge() const { return 1; }
  std::uint64_t first_face() const { return first_edge() + mesh_.edges(); }
  std::uint64_t first_tet() const { return first_face() + cells_.faces(); }

  static std::string real(double value) {
    std::string text = fmt::format("{:25.16E}", value);
    text[text.find('E')] = 'D';
    return text;
  }

  void open(int dataset) { text_.line("{}{:6}", kDelimiter, dataset); }

  void head(std::uint64_t id, std::uint64_t type, std::uint64_t property, std::uint64_t count) {
    constexpr std::uint64_t kColor = 7;
    text_.field(10, id).field(10, type).field(10, property + 1).field(10, one).field(10, kColor).field(10, count);
    text_ << '\n';
  }

  /// Linear elements list their corners; `places` is for those of second order.
  void nodes(std::span<const VertexIndex> all, std::span<const std::uint8_t> places) {
    constexpr std::size_t kInLine = 8;
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (k == kInLine) text_ << '\n';
      text_.field(10, std::uint64_t{all[mesh_.second_order() ? places[k] : k]} + 1);
    }
    text_ << '\n';
  }

  /// Zones of faces lie inside, patches outside, where each face has one.
  bool is_patch_or_zone(const Part& part) const {
    if (part.kind != Kind::kFaces || part.members.empty()) return part.kind == Kind::kElements;
    const std::size_t boundary = mesh_.mesh().boundary.size();
    return part.members.front() >= boundary || (part.origin == Part::Origin::kPatch && part.members.back() < boundary);
  }

  /// Those that are wanted, numbered as they stand in the list of all.
  template <class Wanted>
  void write_groups(int dataset, const Wanted& wanted) {
    bool is_open = false;
    for (std::size_t p = 0; p < mesh_.parts().size(); ++p) {
      if (!wanted(mesh_.parts()[p])) continue;
      if (!is_open) open(dataset);
      is_open = true;
      write_group(mesh_.parts()[p], p + 1);
    }
    if (is_open) text_ << kDelimiter;
  }

  void write_group(const Part& part, std::uint64_t number) {
    const std::uint64_t type = part.kind == Kind::kNodes ? 7 : 8;
    const std::uint64_t first = part.kind == Kind::kFaces      ? first_face()
                                : part.kind == Kind::kElements ? first_tet()
                                                               : 1;
    text_.field(10, number) << "         0         0         0         0         0         0";
    const std::vector<std::uint32_t> members = cells_.members(part);
    text_.field(10, std::uint64_t{members.size()}) << '\n';
    text_ << names_[number - 1] << '\n';
    for (std::size_t i = 0; i < members.size(); ++i) {
      text_.field(10, type).field(10, first + members[i]) << "         0         0";
      if (i % 2 == 1 || i + 1 == members.size()) text_ << '\n';
    }
  }

  TextWriter text_;
  const MeshParts& mesh_;
  MixedCells cells_;
  std::vector<std::string> names_;
  CellRoom solid_;
  FaceRoom face_;
  EdgeRoom edge_;
};

}  // namespace

void write_unv(MeshOutput& out, const MeshParts& mesh) {
  if (std::ranges::any_of(mesh.wide_cells(), [](const WideCell& cell) { return cell.tet_count == 2; }))
    out.note("I-deas has no pyramids: they are wedges here with one edge of no length");
  UnvWriter(out, mesh).write();
}

}  // namespace octafront::io
