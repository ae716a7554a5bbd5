// CGNS: a section of elements per region, patch and curve (and kind of element: wedges, pyramids and quadrilaterals are
// sections behind), and a boundary condition with a family for each patch. Fields are solutions at vertices and in
// cells, vectors as VelocityX to VelocityZ. Numbers count from 1.

#include "formats/parts/field_columns.h"
#include "formats/parts/mixed_cells.h"
#include "formats/write/cgns_file.h"
#include "formats/write/writers.h"

#include <array>
#include <string>

#include <fmt/core.h>

namespace octafront::io {
namespace {

using Kind = NamedSet::Kind;
using Origin = Part::Origin;

class CgnsWriter {
 public:
  CgnsWriter(MeshOutput& out, const MeshParts& mesh)
      : file_(out, mesh, 3.4F),
        mesh_(mesh),
        cells_(mesh),
        of_nodes_(field_columns(out, false, CgnsFile::kRules, ComponentNames::kCapitals)),
        of_cells_(field_columns(out, true, CgnsFile::kRules, ComponentNames::kCapitals)) {}

  void write() {
    file_.begin_zone(mesh_.points(), cells_.cells(), [&](std::uint64_t v) { return mesh_.mesh().points[v]; });
    ranges_.resize(mesh_.parts().size());
    for (std::size_t p = 0; p < ranges_.size(); ++p)
      if (mesh_.parts()[p].origin != Origin::kSet) write_sections(p);
    file_.conditions(ranges_);
    const auto value_of = [&](const MeshField& field, std::uint64_t i, std::size_t k) {
      return cells_.value_of(field, field.of_elements ? order_[i] : i, k);
    };
    file_.solution(of_nodes_, false, mesh_.points(), value_of);
    file_.solution(of_cells_, true, cells_.cells(), value_of);
    file_.close();
  }

 private:
  /// What CGNS calls a kind of element, linear and of second order, and what tells its sections apart.
  struct SectionType {
    std::array<std::int32_t, 2> number;
    const char* suffix;
  };

  SectionType type_of(Kind kind, std::uint32_t element) const {
    constexpr std::array<SectionType, MixedCells::kKinds> kSolids{
        SectionType{{10, 11}, ""}, SectionType{{12, 21}, " pyramids"}, SectionType{{14, 15}, " wedges"}};
    if (kind == Kind::kElements) return kSolids[cells_.kind(element)];
    if (kind == Kind::kFaces)
      return element < cells_.triangles() ? SectionType{{5, 6}, ""} : SectionType{{7, 8}, " quads"};
    return {{3, 4}, ""};
  }

  std::size_t nodes_of(Kind kind, std::uint32_t element) const {
    if (kind == Kind::kElements) return cells_.nodes_per(cells_.kind(element));
    if (kind == Kind::kEdges) return mesh_.nodes_per_edge();
    return element < cells_.triangles() ? mesh_.nodes_per_face() : cells_.nodes_per_quad();
  }

  /// The sections of a part: the parts follow each other.
  void write_sections(std::size_t p) {
    const Part& part = mesh_.parts()[p];
    const std::vector<std::uint32_t> all = cells_.members(part);
    if (part.kind == Kind::kElements) order_.insert(order_.end(), all.begin(), all.end());
    ranges_[p][0] = next_;
    for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
      const SectionType type = type_of(part.kind, all[begin]);
      while (end < all.size() && type_of(part.kind, all[end]).number == type.number) ++end;
      const std::string prefix = part.kind == Kind::kElements ? "" : part.kind == Kind::kFaces ? "faces " : "edges ";
      const std::string suffix = begin == 0 ? "" : type.suffix;
      const std::string name = (prefix + file_.names()[p]).substr(0, CgnsFile::kName - 1 - suffix.size()) + suffix;
      write_section(name, part.kind, type, std::span(all).subspan(begin, end - begin));
    }
    ranges_[p][1] = next_ - 1;
  }

  /// Elements of one kind.
  void write_section(const std::string& name, Kind kind, const SectionType& type,
                     std::span<const std::uint32_t> elements) {
    const std::int32_t first = next_, last = first + static_cast<std::int32_t>(elements.size()) - 1;
    next_ = last + 1;
    const std::string section = file_.section(name, type.number[mesh_.second_order()], first, last);
    const std::uint64_t each = nodes_of(kind, elements.front());
    file_.array<std::int32_t>(
        section + "/ElementConnectivity", "DataArray_t", each * elements.size(), [&](std::uint64_t i) {
          const std::uint32_t m = elements[i / each];
          const std::uint64_t k = i % each;
          return 1 + static_cast<std::int32_t>(kind == Kind::kElements ? cells_.node(m, k, kCgnsWide)
                                               : kind == Kind::kFaces  ? cells_.face_node(m, k)
                                                                       : mesh_.edge_node(m, k));
        });
  }

  CgnsFile file_;
  const MeshParts& mesh_;
  MixedCells cells_;
  std::vector<FieldColumn> of_nodes_, of_cells_;
  std::vector<std::uint32_t> order_;                 ///< cells as their sections stand
  std::int32_t next_ = 1;                            ///< the number of the next element
  std::vector<std::array<std::int32_t, 2>> ranges_;  ///< of the parts: their first and last elements
};

}  // namespace

void write_cgns(MeshOutput& out, const MeshParts& mesh) {
  out.require_32_bits(std::max(mesh.points(), mesh.tets() + mesh.faces() + mesh.edges()),
                      "too many elements for CGNS with 32 bits; write .vtu");
  CgnsWriter(out, mesh).write();
}

}  // namespace octafront::io
