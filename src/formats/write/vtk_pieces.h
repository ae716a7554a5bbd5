#pragma once

// A piece of a mesh as VTK's parallel files have it: the cells and data of formats/parts/vtk_cells.h, and
//   vtkGhostType                    1 of points and cells that another part has for its own, 0 of others
//   GlobalPointIds, GlobalCellIds   numbers in the file that would hold the whole mesh
//   part                            of cells: whose own they are

#include "formats/parts/mesh_parts.h"
#include "formats/parts/pieces.h"
#include "formats/parts/vtk_cells.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

namespace octafront::io {

class AtomicFile;
class MeshOutput;

inline constexpr std::string_view kGhostType = "vtkGhostType", kGlobalPointIds = " GlobalIds=\"GlobalPointIds\"",
                                  kGlobalCellIds = " GlobalIds=\"GlobalCellIds\"";
/// VTK takes numbers for global ones only if their type is the one of its own indices.
inline constexpr std::string_view kIdType = "Int64\" IdType=\"1";

/// What all pieces of a mesh must agree about.
struct VtkWhole {
  VtkCells::Shown shown;
  VtkCells::Names names;
  WholeCounts counts;

  static VtkWhole of(const Pieces& pieces) {
    return {VtkCells::Shown::of(pieces.whole()), VtkCells::names_of(pieces.whole()), pieces.counts()};
  }
};

/// A piece, as writers see it. Refers to both.
struct VtkPiece {
  VtkPiece(const Piece& of, const VtkWhole& in)
      : piece(of), whole(in), mesh(of.mesh, {.faces = in.counts.faces == 0, .last_points = of.last_points}) {}

  std::uint8_t ghost_type_of_point(std::uint64_t v) const { return piece.point_part[v] != piece.number ? 1 : 0; }
  std::int64_t id_of_point(std::uint64_t v) const { return static_cast<std::int64_t>(piece.point_ids[v]); }
  std::uint32_t part_of_cell(const VtkCells& cells, std::uint64_t c) const {
    return c < cells.first_edge() ? piece.tet_part[cells.tet_of(c)] : piece.edge_part[c - cells.first_edge()];
  }
  std::uint8_t ghost_type_of_cell(const VtkCells& cells, std::uint64_t c) const {
    return part_of_cell(cells, c) != piece.number ? 1 : 0;
  }
  std::int64_t id_of_cell(const VtkCells& cells, std::uint64_t c) const {
    const auto& [points, all_cells, faces, edges] = whole.counts;
    if (c < cells.first_face()) return static_cast<std::int64_t>(piece.cell_ids[cells.tet_of(c)]);
    if (c < cells.first_edge())
      return static_cast<std::int64_t>(all_cells + piece.face_ids[cells.elements().first_face(c - cells.first_face())]);
    return static_cast<std::int64_t>(all_cells + faces + piece.edge_ids[c - cells.first_edge()]);
  }

  const Piece& piece;
  const VtkWhole& whole;
  MeshParts mesh;
};

/// One piece as a file of its own, which a .pvtu names.
void write_vtu_piece(AtomicFile& file, const VtkPiece& piece, bool as_text);

/// A .pvtu by several hands: the folder for its pieces is begun, each is written into it, and the file that names them
/// ends it. `target`: of the .pvtu.
std::filesystem::path begin_pvtu(MeshOutput& out);
void write_pvtu_piece(const std::filesystem::path& folder, const std::filesystem::path& target, const Piece& piece,
                      const VtkWhole& whole, const RunContext& context, bool as_text);
void end_pvtu(MeshOutput& output, const MeshParts& mesh, std::span<const MeshField> fields, const VtkWhole& whole,
              std::uint32_t parts);

}  // namespace octafront::io
