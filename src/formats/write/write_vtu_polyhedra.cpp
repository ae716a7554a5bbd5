// VTU of polyhedra: polyhedra by their points and faces, then the polygons of patches, with the data `region` and
// `patch` as write_vtu.cpp has them. Values at vertices of the tetrahedra are those of cells.

#include "base/dual/poly_measures.h"
#include "formats/containers/text_writer.h"
#include "formats/containers/vtk_xml.h"
#include "formats/containers/vtu_arrays.h"
#include "formats/parts/vtk_cells.h"
#include "formats/write/vtu_head.h"
#include "formats/write/writers.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace octafront::io {
namespace {

constexpr std::uint8_t kPolygon = 7, kPolyhedron = 42;

class VtuPolyhedra {
 public:
  VtuPolyhedra(AtomicFile& file, const MeshOutput& out, const MeshParts& parts, const PolyMesh& mesh)
      : parts_(parts), mesh_(mesh), fields_(out.fields()), out_(file), arrays_(file, out.as_text()) {
    for (std::uint32_t f = 0; f < mesh.faces(); ++f)
      if (mesh.patch[f] != kNone || f >= mesh.inner_faces()) polygons_.push_back(f);
    // The boundary comes first, interfaces behind it, as in files of tetrahedra.
    std::ranges::stable_partition(polygons_, [&](std::uint32_t f) { return f >= mesh.inner_faces(); });
    list_cells();
    begin_vtu(out_, out.as_text(), VtkCells::names_of(parts), mesh.points.size(), cells());
  }

  void write() {
    out_ << "      <Points>\n";
    arrays_.declare<double>("Float64", "Points", 3, 3 * std::uint64_t{mesh_.points.size()},
                            [this](std::uint64_t i) { return mesh_.points[i / 3][static_cast<int>(i % 3)]; });
    out_ << "      </Points>\n      <Cells>\n";
    declare("connectivity", nodes_);
    declare("offsets", node_ends_);
    arrays_.declare<std::uint8_t>("UInt8", "types", 1, cells(),
                                  [this](std::uint64_t c) { return c < mesh_.cells() ? kPolyhedron : kPolygon; });
    declare("faces", faces_);
    declare("faceoffsets", face_ends_);
    out_ << "      </Cells>\n      <PointData>\n      </PointData>\n      <CellData Scalars=\"region\">\n";
    declare_data();
    out_ << "      </CellData>\n";
    end_vtu(out_, arrays_);
  }

 private:
  std::uint64_t cells() const { return mesh_.cells() + polygons_.size(); }

  void declare(std::string_view name, const std::vector<std::int64_t>& values) {
    arrays_.declare<std::int64_t>("Int64", name, 1, values.size(), [&values](std::uint64_t i) { return values[i]; });
  }

  void list_cells() {
    const Groups<> faces = dual::faces_of_cells(mesh_);
    for (std::uint32_t c = 0; c < mesh_.cells(); ++c) {
      const auto first = static_cast<std::ptrdiff_t>(nodes_.size());
      faces_.push_back(static_cast<std::int64_t>(faces[c].size()));
      for (const std::uint32_t f : faces[c]) {
        const auto points = mesh_.face(f);
        faces_.push_back(static_cast<std::int64_t>(points.size()));
        const auto at = static_cast<std::ptrdiff_t>(faces_.size());
        faces_.insert(faces_.end(), points.begin(), points.end());
        if (mesh_.owner[f] != c) std::reverse(faces_.begin() + at, faces_.end());
        nodes_.insert(nodes_.end(), points.begin(), points.end());
      }
      std::sort(nodes_.begin() + first, nodes_.end());
      nodes_.erase(std::unique(nodes_.begin() + first, nodes_.end()), nodes_.end());
      node_ends_.push_back(static_cast<std::int64_t>(nodes_.size()));
      face_ends_.push_back(static_cast<std::int64_t>(faces_.size()));
    }
    for (const std::uint32_t f : polygons_) {
      nodes_.insert(nodes_.end(), mesh_.face(f).begin(), mesh_.face(f).end());
      node_ends_.push_back(static_cast<std::int64_t>(nodes_.size()));
      face_ends_.push_back(-1);
    }
  }

  /// The polyhedron that a cell of the file is, or belongs to.
  std::uint32_t polyhedron(std::uint64_t c) const {
    return c < mesh_.cells() ? static_cast<std::uint32_t>(c) : mesh_.owner[polygons_[c - mesh_.cells()]];
  }

  void declare_data() {
    arrays_.declare<std::int32_t>("Int32", "region", 1, cells(), [this](std::uint64_t c) {
      return static_cast<std::int32_t>(mesh_.region[polyhedron(c)]);
    });
    arrays_.declare<std::int32_t>("Int32", "patch", 1, cells(), [this](std::uint64_t c) {
      return c < mesh_.cells() ? -1 : static_cast<std::int32_t>(mesh_.patch[polygons_[c - mesh_.cells()]]);
    });
    if (!parts_.labels().empty())
      arrays_.declare<std::int32_t>("Int32", "label", 1, cells(),
                                    [this](std::uint64_t c) { return parts_.labels()[mesh_.region[polyhedron(c)]]; });
    for (const MeshField& field : fields_) {
      const std::uint64_t n = field.components;
      arrays_.declare<double>(
          "Float64", escaped(field.name), static_cast<int>(n), n * cells(),
          [this, &field, n](std::uint64_t i) { return field.values[mesh_.vertex[polyhedron(i / n)] * n + i % n]; });
    }
  }

  const MeshParts& parts_;
  const PolyMesh& mesh_;
  std::span<const MeshField> fields_;
  TextWriter out_;
  VtuArrays arrays_;
  std::vector<std::uint32_t> polygons_;  ///< faces of patches
  std::vector<std::int64_t> nodes_, node_ends_, faces_, face_ends_;
};

}  // namespace

void write_vtu_polyhedra(MeshOutput& out, const MeshParts& parts, const PolyMesh& mesh) {
  VtuPolyhedra(out.file(), out, parts, mesh).write();
}

}  // namespace octafront::io
