// Nastran bulk data: GRID in large fields (16 columns), elements in small ones. A region is a PSOLID, a patch the
// CTRIA3/CTRIA6 (CQUAD4/CQUAD8) of a PSHELL without material, numbered behind the solids; curves, as their nodes, and
// sets are SETs of the case control. Names are comments: "$ NAME PSOLID 1 "left part"".

#include "formats/containers/text_writer.h"
#include "formats/parts/mixed_cells.h"
#include "formats/write/job_writers.h"
#include "formats/write/writers.h"

#include <algorithm>
#include <array>
#include <span>

namespace octafront::io {
namespace {

using Kind = NamedSet::Kind;
using Origin = Part::Origin;

class NastranWriter {
 public:
  NastranWriter(MeshOutput& out, const MeshParts& mesh)
      : text_(out.file()), mesh_(mesh), cells_(mesh), job_(out.job()) {
    for (const Part& region : mesh.parts(Origin::kRegion)) first_shell_ = std::max(first_shell_, region.tag + 1);
  }

  void write() {
    if (job_ != nullptr)
      write_nastran_control(text_, mesh_, *job_);
    else
      text_ << "$ Mesh by octafront: materials and what loads it are for you to add\n";
    write_names();
    std::uint64_t number = 0;
    for (const Part& part : mesh_.parts())
      if (part.origin == Origin::kSet || part.origin == Origin::kCurve) write_set(part, ++number);
    text_ << "BEGIN BULK\n";
    for (const Part& region : mesh_.parts(Origin::kRegion)) card("PSOLID", region.tag, region.tag);
    for (const Part& patch : shells()) card("PSHELL", first_shell_ + patch.number);
    for (std::uint64_t v = 0; v < mesh_.points(); ++v) {
      const Vec3 p = mesh_.mesh().points[v];
      (text_ << "GRID*   ").field(16, v + 1) << "                ";
      text_.field(16, p.x).field(16, p.y) << "\n*       ";
      text_.field(16, p.z);
      if (const std::uint64_t system = job_ == nullptr ? 0 : nastran_system_of(*job_, static_cast<VertexIndex>(v)))
        text_.field(16, system);
      text_ << '\n';
    }
    if (job_ == nullptr) write_faces();
    write_solids();
    if (job_ != nullptr) write_nastran_job(text_, mesh_, *job_, cells_.cells() + 1);
    text_ << "ENDDATA\n";
  }

 private:
  /// Faces without a material are none of the elements that a job has.
  std::span<const Part> shells() const {
    return job_ == nullptr ? mesh_.parts(Origin::kPatch) : std::span<const Part>();
  }

  void write_faces() {
    constexpr std::array<std::array<const char*, 2>, 2> kCards{{{"CTRIA3  ", "CTRIA6  "}, {"CQUAD4  ", "CQUAD8  "}}};
    FaceRoom room;
    for (std::size_t f = 0; f < cells_.faces(); ++f)
      element(kCards[f >= cells_.triangles()][mesh_.second_order()], cells_.cells() + f + 1,
              first_shell_ + std::uint64_t{mesh_.patch_of(cells_.first_face(f))}, cells_.face_nodes(f, room));
  }

  void write_solids() {
    constexpr std::array<const char*, MixedCells::kKinds> kCards{"CTETRA  ", "CPYRAM  ", "CPENTA  "};
    CellRoom room;
    for (std::size_t c = 0; c < cells_.cells(); ++c)
      element(kCards[cells_.kind(c)], c + 1, std::uint64_t{mesh_.tag_of_region(mesh_.region_of(cells_.first_tet(c)))},
              cells_.nodes(c, room, kCgnsWide));
  }

  void name(std::string_view of, std::uint64_t number, const Part& part) {
    if (part.is_named) text_.line("$ NAME {} {} \"{}\"", of, number, one_line(part.name));
  }

  void write_names() {
    for (const Part& region : mesh_.parts(Origin::kRegion)) name("PSOLID", region.tag, region);
    for (const Part& patch : shells()) name("PSHELL", first_shell_ + patch.number, patch);
    std::uint64_t number = 0;
    for (const Part& part : mesh_.parts())
      if (part.origin == Origin::kSet || part.origin == Origin::kCurve) {
        const bool of_nodes = part.kind == Kind::kNodes || part.kind == Kind::kEdges;
        text_.line("$ NAME SET {} {} \"{}\"", ++number, of_nodes ? "GRID" : "ELEM", one_line(part.name));
      }
  }

  /// SET 1 = 1, 2, 3 THRU 7: lines end with a comma where the set goes on.
  void write_set(const Part& part, std::uint64_t number) {
    std::vector<std::uint64_t> ids;
    if (part.kind == Kind::kNodes || part.kind == Kind::kEdges) {
      for (const VertexIndex v : mesh_.nodes_of(part)) ids.push_back(std::uint64_t{v} + 1);
    } else {
      const std::uint64_t first = part.kind == Kind::kFaces ? cells_.cells() : 0;
      for (const std::uint32_t m : cells_.members(part)) ids.push_back(first + m + 1);
    }
    if (ids.empty()) return;
    text_ << "SET " << number << " = ";
    int in_line = 0;
    for (std::size_t i = 0, j = 0; i < ids.size(); i = j) {
      while (j < ids.size() && ids[j] == ids[i] + (j - i)) ++j;
      // A run of two is no shorter as such.
      if (j - i < 3) j = i + 1;
      text_ << ids[i];
      if (j - i > 1) text_ << " THRU " << ids[j - 1];
      constexpr int kMostInLine = 3;
      const bool full = ++in_line % kMostInLine == 0;
      text_ << (j == ids.size() ? "\n" : full ? ",\n" : ", ");
    }
  }

  template <class... Fields>
  void card(std::string_view name_of, Fields... fields) {
    text_ << name_of << std::string_view("        ").substr(name_of.size());
    (text_.field(8, std::uint64_t{fields}), ...);
    text_ << '\n';
  }

  void element(std::string_view name_of, std::uint64_t id, std::uint64_t property, std::span<const VertexIndex> nodes) {
    text_ << name_of;
    text_.field(8, id).field(8, property);
    constexpr std::size_t kInFirstLine = 6, kInLine = 8;
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      if (k == kInFirstLine || (k > kInFirstLine && (k - kInFirstLine) % kInLine == 0)) text_ << "+\n+       ";
      text_.field(8, std::uint64_t{nodes[k]} + 1);
    }
    text_ << '\n';
  }

  TextWriter text_;
  const MeshParts& mesh_;
  MixedCells cells_;
  const JobPlan* job_;             ///< null: the mesh alone
  std::uint32_t first_shell_ = 1;  ///< the property of patch 0
};

}  // namespace

void write_nastran(MeshOutput& out, const MeshParts& mesh) {
  NastranWriter(out, mesh).write();
}

}  // namespace octafront::io
