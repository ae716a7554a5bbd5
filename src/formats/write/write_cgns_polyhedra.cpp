// CGNS of polyhedra: faces as NGON_n with the offsets of version 3.4, first those between cells, then a section for
// each patch with its boundary condition; cells as NFACE_n, a section for each region, by their faces, which are
// negative where they look inward. Values at vertices of the tetrahedra are solutions in cells.

#include "base/dual/poly_measures.h"
#include "formats/write/cgns_file.h"
#include "formats/write/writers.h"

#include <algorithm>
#include <numeric>

namespace octafront::io {
namespace {

using Origin = Part::Origin;

constexpr std::int32_t kNgon = 22, kNface = 23;

class CgnsPolyhedra {
 public:
  CgnsPolyhedra(MeshOutput& out, const MeshParts& parts, const PolyMesh& mesh)
      // From this version on polygons are told by where they begin.
      : file_(out, parts, 3.4F),
        parts_(parts),
        mesh_(mesh),
        of_vertices_(field_columns(out, false, CgnsFile::kRules, ComponentNames::kCapitals)) {}

  void write() {
    file_.begin_zone(mesh_.points.size(), mesh_.cells(), [&](std::uint64_t p) { return mesh_.points[p]; });
    order_faces();
    write_faces();
    write_cells();
    file_.conditions(ranges_);
    file_.solution(of_vertices_, true, mesh_.cells(), [&](const MeshField& field, std::uint64_t i, std::size_t k) {
      return field.values[mesh_.vertex[cells_[i]] * field.components + k];
    });
    file_.close();
  }

 private:
  /// Those of no patch, then those of each.
  void order_faces() {
    const auto place = [&](std::uint32_t f) { return mesh_.patch[f] == kNone ? 0 : mesh_.patch[f] + std::uint64_t{1}; };
    faces_.resize(mesh_.faces());
    std::iota(faces_.begin(), faces_.end(), 0U);
    std::ranges::stable_sort(faces_, {}, place);
    number_.resize(faces_.size());
    for (std::size_t i = 0; i < faces_.size(); ++i) number_[faces_[i]] = static_cast<std::int32_t>(i) + 1;
  }

  void write_faces() {
    ranges_.resize(parts_.parts().size());
    const std::size_t plain = count_of_patch(kNone);
    if (plain > 0) write_faces("faces", 0, plain);
    std::size_t begin = plain;
    for (std::size_t p = 0; p < ranges_.size(); ++p) {
      const Part& part = parts_.parts()[p];
      if (part.origin != Origin::kPatch) continue;
      const std::size_t end = begin + count_of_patch(part.number);
      if (end > begin) write_faces(("faces " + file_.names()[p]).substr(0, CgnsFile::kName - 1), begin, end);
      ranges_[p] = {static_cast<std::int32_t>(begin) + 1, static_cast<std::int32_t>(end)};
      begin = end;
    }
  }
  std::size_t count_of_patch(std::uint32_t patch) const {
    return static_cast<std::size_t>(std::ranges::count(mesh_.patch, patch));
  }

  void write_faces(const std::string& name, std::size_t begin, std::size_t end) {
    std::vector<std::int32_t> starts{0}, points;
    for (std::size_t i = begin; i < end; ++i) {
      for (const VertexIndex p : mesh_.face(faces_[i])) points.push_back(static_cast<std::int32_t>(p) + 1);
      starts.push_back(static_cast<std::int32_t>(points.size()));
    }
    write_section(name, kNgon, static_cast<std::int32_t>(begin) + 1, starts, points);
  }

  void write_cells() {
    const Groups<> faces = dual::faces_of_cells(mesh_);
    auto next = static_cast<std::int32_t>(mesh_.faces()) + 1;
    for (std::size_t p = 0; p < parts_.parts().size(); ++p) {
      if (parts_.parts()[p].origin != Origin::kRegion) continue;
      std::vector<std::int32_t> starts{0}, sides;
      for (std::uint32_t c = 0; c < mesh_.cells(); ++c) {
        if (mesh_.region[c] != parts_.parts()[p].number) continue;
        cells_.push_back(c);
        for (const std::uint32_t f : faces[c]) sides.push_back(mesh_.owner[f] == c ? number_[f] : -number_[f]);
        starts.push_back(static_cast<std::int32_t>(sides.size()));
      }
      write_section(file_.names()[p], kNface, next, starts, sides);
      next += static_cast<std::int32_t>(starts.size()) - 1;
    }
  }

  void write_section(const std::string& name, std::int32_t type, std::int32_t first,
                     const std::vector<std::int32_t>& starts, const std::vector<std::int32_t>& members) {
    const auto last = first + static_cast<std::int32_t>(starts.size()) - 2;
    const std::string section = file_.section(name, type, first, last);
    file_.array<std::int32_t>(section + "/ElementStartOffset", "DataArray_t", starts.size(),
                              [&](std::uint64_t i) { return starts[i]; });
    file_.array<std::int32_t>(section + "/ElementConnectivity", "DataArray_t", members.size(),
                              [&](std::uint64_t i) { return members[i]; });
  }

  CgnsFile file_;
  const MeshParts& parts_;
  const PolyMesh& mesh_;
  std::vector<FieldColumn> of_vertices_;
  std::vector<std::uint32_t> faces_, cells_;         ///< as their sections stand
  std::vector<std::int32_t> number_;                 ///< per face, in the file
  std::vector<std::array<std::int32_t, 2>> ranges_;  ///< of the patches: their first and last faces
};

}  // namespace

void write_cgns_polyhedra(MeshOutput& out, const MeshParts& parts, const PolyMesh& mesh) {
  out.require_32_bits(std::max(mesh.face_points.size(), mesh.faces() + mesh.cells()),
                      "too many faces for CGNS with 32 bits; write .vtu");
  CgnsPolyhedra(out, parts, mesh).write();
}

}  // namespace octafront::io
