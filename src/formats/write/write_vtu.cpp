// VTK unstructured grid (XML): the cells and data of formats/parts/vtk_cells.h, and
//   beta    quality of a tetrahedron, of a pyramid or wedge that of its first one; a face has that of its tetrahedron,
//   so that face and tetrahedron, which a viewer
//           draws at the same place, have one colour
// A piece of a mesh (.pvtu) has what formats/write/vtk_pieces.h says, too.

#include <octafront/quality.h>

#include "formats/containers/text_writer.h"
#include "formats/containers/vtk_xml.h"
#include "formats/containers/vtu_arrays.h"
#include "formats/parts/vtk_cells.h"
#include "formats/write/vtk_pieces.h"
#include "formats/write/vtu_head.h"
#include "formats/write/writers.h"

#include <limits>

namespace octafront::io {
namespace {

class VtuWriter {
 public:
  /// `piece`: what the mesh is a piece of; null: nothing.
  VtuWriter(AtomicFile& file, const MeshParts& parts, std::span<const MeshField> fields, bool as_text,
            const VtkPiece* piece = nullptr)
      : parts_(parts),
        mesh_(parts.mesh()),
        fields_(fields),
        out_(file),
        arrays_(file, as_text),
        cells_(parts, piece == nullptr ? VtkCells::Shown::of(parts) : piece->whole.shown),
        piece_(piece),
        as_text_(as_text) {}

  void write() {
    begin_vtu(out_, as_text_, piece_ == nullptr ? cells_.names() : piece_->whole.names, parts_.points(), cells_.size());
    declare_points();
    declare_cells();
    declare_data();
    end_vtu(out_, arrays_);
  }

 private:
  void declare_points() {
    out_ << "      <Points>\n";
    arrays_.declare<double>("Float64", "Points", 3, 3 * std::uint64_t{parts_.points()},
                            [this](std::uint64_t i) { return mesh_.points[i / 3][static_cast<int>(i % 3)]; });
    out_ << "      </Points>\n";
  }

  template <class T>
  void declare_indices(std::string_view type) {
    arrays_.declare<T>(type, "connectivity", 1, cells_.nodes(),
                       [this](std::uint64_t i) { return static_cast<T>(cells_.node(i)); });
    arrays_.declare<T>(type, "offsets", 1, cells_.size(),
                       [this](std::uint64_t i) { return static_cast<T>(cells_.end_of(i)); });
  }

  void declare_cells() {
    constexpr std::uint64_t kMostInt32 = std::numeric_limits<std::int32_t>::max();
    out_ << "      <Cells>\n";
    if (cells_.nodes() <= kMostInt32 && parts_.points() <= kMostInt32) {
      declare_indices<std::int32_t>("Int32");
    } else {
      declare_indices<std::int64_t>("Int64");
    }
    arrays_.declare<std::uint8_t>("UInt8", "types", 1, cells_.size(),
                                  [this](std::uint64_t i) { return cells_.type(i); });
    out_ << "      </Cells>\n";
  }

  void declare_arrays(bool of_points) {
    for (std::size_t d = 0; d < cells_.data().size(); ++d) {
      const VtkCells::Data& data = cells_.data()[d];
      if (data.of_points != of_points) continue;
      const std::uint64_t count = of_points ? parts_.points() : cells_.size();
      if (data.is_set) {
        arrays_.declare<std::uint8_t>("UInt8", escaped(data.name), 1, count, [this, d](std::uint64_t i) {
          return static_cast<std::uint8_t>(cells_.value(d, i));
        });
      } else {
        arrays_.declare<std::int32_t>("Int32", data.name, 1, count,
                                      [this, d](std::uint64_t i) { return cells_.value(d, i); });
      }
    }
  }

  void declare_fields(bool of_points) {
    for (const MeshField& field : fields_) {
      if (field.of_elements == of_points) continue;
      const std::uint64_t n = field.components, count = of_points ? parts_.points() : cells_.size();
      arrays_.declare<double>("Float64", escaped(field.name), n, n * count,
                              [this, &field, n](std::uint64_t i) { return cells_.value_of(field, i / n, i % n); });
    }
  }

  void declare_data() {
    out_.line("      <PointData{}>", piece_ == nullptr ? "" : kGlobalPointIds);
    if (piece_ != nullptr) declare_place_of_points();
    declare_arrays(true);
    declare_fields(true);
    out_.line("      </PointData>\n      <CellData Scalars=\"beta\"{}>", piece_ == nullptr ? "" : kGlobalCellIds);
    if (piece_ != nullptr) declare_place_of_cells();
    declare_arrays(false);
    declare_fields(false);
    arrays_.declare<float>("Float32", "beta", 1, cells_.size(), [this](std::uint64_t i) {
      const TetIndex t = cells_.tet_of(i);
      if (t == kNone) return 0.0F;
      const auto& [a, b, c, d] = mesh_.tets[t];
      return static_cast<float>(radius_ratio(mesh_.points[a], mesh_.points[b], mesh_.points[c], mesh_.points[d]));
    });
    out_ << "      </CellData>\n";
  }

  void declare_place_of_points() {
    arrays_.declare<std::uint8_t>("UInt8", kGhostType, 1, parts_.points(),
                                  [this](std::uint64_t v) { return piece_->ghost_type_of_point(v); });
    arrays_.declare<std::int64_t>(kIdType, "GlobalPointIds", 1, parts_.points(),
                                  [this](std::uint64_t v) { return piece_->id_of_point(v); });
  }

  void declare_place_of_cells() {
    arrays_.declare<std::uint8_t>("UInt8", kGhostType, 1, cells_.size(),
                                  [this](std::uint64_t c) { return piece_->ghost_type_of_cell(cells_, c); });
    arrays_.declare<std::int64_t>(kIdType, "GlobalCellIds", 1, cells_.size(),
                                  [this](std::uint64_t c) { return piece_->id_of_cell(cells_, c); });
    arrays_.declare<std::int32_t>("Int32", "part", 1, cells_.size(), [this](std::uint64_t c) {
      return static_cast<std::int32_t>(piece_->part_of_cell(cells_, c));
    });
  }

  const MeshParts& parts_;
  const TetMesh& mesh_;
  std::span<const MeshField> fields_;
  TextWriter out_;
  VtuArrays arrays_;
  VtkCells cells_;
  const VtkPiece* piece_;
  bool as_text_;
};

}  // namespace

void write_vtu(MeshOutput& out, const MeshParts& mesh) {
  VtuWriter(out.file(), mesh, out.fields(), out.as_text()).write();
}

void write_vtu_piece(AtomicFile& file, const VtkPiece& piece, bool as_text) {
  VtuWriter(file, piece.mesh, piece.piece.fields, as_text, &piece).write();
}

}  // namespace octafront::io
