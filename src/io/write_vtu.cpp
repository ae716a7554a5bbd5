// VTK unstructured grid (XML). Cells are the tetrahedra first, then the boundary triangles. Data of the cells:
//   region  body of the tetrahedron; a triangle has that of its tetrahedron
//   patch   patch of the triangle; -1 for tetrahedra
//   source  input face that the triangle still is; -1 for others (left out if there is none)
//   beta    quality of the tetrahedron; a triangle has that of its tetrahedron, so that triangle and tetrahedron, which
//           a viewer draws at the same place, have one colour
// Patch names are field data: an array "patch NAME" that holds the number of the patch.

#include <octafront/quality.h>

#include "io/boundary.h"
#include "io/text_writer.h"
#include "io/vtu_arrays.h"
#include "io/writers.h"

#include <algorithm>
#include <limits>
#include <string>

namespace octafront::io {
namespace {

constexpr std::uint8_t kVtkTriangle = 5, kVtkTetra = 10;

std::string escaped(std::string_view name) {
  std::string out;
  for (const char c : name) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return out;
}

class VtuWriter {
 public:
  VtuWriter(AtomicFile& file, const TetMesh& mesh)
      : mesh_(mesh),
        out_(file),
        arrays_(file),
        tets_(mesh.tets.size()),
        cells_(tets_ + mesh.boundary.size()),
        tet_of_triangle_(tets_of_faces(mesh.tets, mesh.boundary, mesh.points.size())) {}

  void write() {
    out_ << "<?xml version=\"1.0\"?>\n"
            "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\" "
            "compressor=\"vtkZLibDataCompressor\">\n"
            "  <UnstructuredGrid>\n";
    write_names();
    out_ << "    <Piece NumberOfPoints=\"" << std::uint64_t{mesh_.points.size()} << "\" NumberOfCells=\"" << cells_
         << "\">\n";
    declare_points();
    declare_cells();
    declare_cell_data();
    out_ << "    </Piece>\n  </UnstructuredGrid>\n";
    arrays_.write_data();
    out_ << "</VTKFile>\n";
  }

 private:
  bool is_tet(std::uint64_t cell) const { return cell < tets_; }
  /// The tetrahedron that speaks for the cell.
  TetIndex tet_of(std::uint64_t cell) const {
    return is_tet(cell) ? static_cast<TetIndex>(cell) : tet_of_triangle_[cell - tets_];
  }

  void write_names() {
    out_ << "    <FieldData>\n";
    for (std::uint32_t p = 0; p < mesh_.patch_names.size(); ++p)
      if (!mesh_.patch_names[p].empty())
        out_ << "      <DataArray type=\"Int32\" Name=\"patch " << escaped(mesh_.patch_names[p])
             << "\" NumberOfTuples=\"1\" format=\"ascii\">" << p << "</DataArray>\n";
    out_ << "    </FieldData>\n";
  }

  void declare_points() {
    out_ << "      <Points>\n";
    arrays_.declare<double>("Float64", "Points", 3, 3 * std::uint64_t{mesh_.points.size()},
                            [this](std::uint64_t i) { return mesh_.points[i / 3][static_cast<int>(i % 3)]; });
    out_ << "      </Points>\n";
  }

  void declare_cells() {
    const std::uint64_t corners = 4 * tets_ + 3 * (cells_ - tets_);
    const auto corner = [this](std::uint64_t i) {
      if (i < 4 * tets_) return mesh_.tets[i / 4][i % 4];
      return mesh_.boundary[(i - 4 * tets_) / 3][(i - 4 * tets_) % 3];
    };
    const auto end_of_cell = [this](std::uint64_t i) {
      return 4 * std::min(i + 1, tets_) + 3 * (i + 1 - std::min(i + 1, tets_));
    };
    constexpr std::uint64_t kMostInt32 = std::numeric_limits<std::int32_t>::max();
    out_ << "      <Cells>\n";
    if (corners <= kMostInt32 && mesh_.points.size() <= kMostInt32) {
      arrays_.declare<std::int32_t>("Int32", "connectivity", 1, corners, corner);
      arrays_.declare<std::int32_t>("Int32", "offsets", 1, cells_, end_of_cell);
    } else {
      arrays_.declare<std::int64_t>("Int64", "connectivity", 1, corners, corner);
      arrays_.declare<std::int64_t>("Int64", "offsets", 1, cells_, end_of_cell);
    }
    arrays_.declare<std::uint8_t>("UInt8", "types", 1, cells_,
                                  [this](std::uint64_t i) { return is_tet(i) ? kVtkTetra : kVtkTriangle; });
    out_ << "      </Cells>\n";
  }

  void declare_cell_data() {
    out_ << "      <CellData Scalars=\"beta\">\n";
    arrays_.declare<std::int32_t>("Int32", "region", 1, cells_, [this](std::uint64_t i) {
      const TetIndex t = tet_of(i);
      return mesh_.region.empty() || t == kNone ? 0 : static_cast<std::int32_t>(mesh_.region[t]);
    });
    arrays_.declare<std::int32_t>("Int32", "patch", 1, cells_, [this](std::uint64_t i) {
      if (is_tet(i)) return -1;
      return mesh_.patch.empty() ? 0 : static_cast<std::int32_t>(mesh_.patch[i - tets_]);
    });
    const auto is_none = [](std::uint32_t face) { return face == kNone; };
    if (!std::all_of(mesh_.source.begin(), mesh_.source.end(), is_none))
      arrays_.declare<std::int32_t>("Int32", "source", 1, cells_, [this](std::uint64_t i) {
        return is_tet(i) ? -1 : static_cast<std::int32_t>(mesh_.source[i - tets_]);
      });
    arrays_.declare<float>("Float32", "beta", 1, cells_, [this](std::uint64_t i) {
      const TetIndex t = tet_of(i);
      if (t == kNone) return 0.0F;
      const auto& [a, b, c, d] = mesh_.tets[t];
      return static_cast<float>(radius_ratio(mesh_.points[a], mesh_.points[b], mesh_.points[c], mesh_.points[d]));
    });
    out_ << "      </CellData>\n";
  }

  const TetMesh& mesh_;
  TextWriter out_;
  VtuArrays arrays_;
  std::uint64_t tets_, cells_;
  std::vector<TetIndex> tet_of_triangle_;
};

}  // namespace

void write_vtu(AtomicFile& file, const TetMesh& mesh) {
  VtuWriter(file, mesh).write();
}

}  // namespace octafront::io
