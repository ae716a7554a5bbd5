#pragma once

#include "formats/parts/mesh_parts.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace octafront::io {

/// Outward faces of wedges and pyramids, as corners of WideCell; the last one of a triangle is repeated. In the order
/// of Abaqus's S1, S2, ...
inline constexpr std::array<std::array<std::size_t, 4>, 5> kWedgeFaces{
    {{0, 2, 1, 1}, {3, 4, 5, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}};
inline constexpr std::array<std::array<std::size_t, 4>, 5> kPyramidFaces{
    {{0, 3, 2, 1}, {0, 1, 4, 4}, {1, 2, 4, 4}, {2, 3, 4, 4}, {3, 0, 4, 4}}};
/// Corners of WideCell in the order of VTK's wedge, whose first triangle faces outward; and the other way.
inline constexpr std::array<std::size_t, 6> kVtkWedge{0, 2, 1, 3, 5, 4};

/// The elements and faces of a mesh for formats that have wedges, pyramids and quadrilaterals: tetrahedra that are
/// part of none first, then pyramids, then wedges; triangles, then quadrilaterals. Without wide cells they are the
/// tetrahedra and faces of the mesh, under their numbers. Refers to the mesh.
class MixedCells {
 public:
  enum Kind : std::size_t { kTet, kPyramid, kWedge, kKinds };

  explicit MixedCells(const MeshParts& mesh);

  std::size_t cells() const { return end_[kWedge]; }
  /// Of the cells of a kind.
  std::size_t begin(Kind kind) const { return kind == kTet ? 0 : end_[kind - 1]; }
  std::size_t end(Kind kind) const { return end_[kind]; }
  Kind kind(std::size_t cell) const { return cell < end_[kTet] ? kTet : cell < end_[kPyramid] ? kPyramid : kWedge; }
  /// The first tetrahedron of a cell.
  TetIndex first_tet(std::size_t cell) const;
  std::size_t cell_of(TetIndex tet) const { return cell_of_.empty() ? tet : cell_of_[tet]; }
  /// Of a tetrahedron as MeshParts has them; of a pyramid or wedge as WideCell.
  std::span<const VertexIndex> nodes(std::size_t cell, std::array<VertexIndex, 10>& room) const;
  const WideCell& wide(std::size_t cell) const { return mesh_.mesh().wide_cells[wide_[cell - end_[kTet]]]; }

  std::size_t faces() const { return triangles() + quads(); }
  std::size_t triangles() const { return mesh_.faces() - 2 * quads(); }
  std::size_t quads() const { return mesh_.faces() == 0 ? 0 : mesh_.mesh().wide_faces.size(); }
  /// The face of the mesh that a triangle is, or the first one of a quadrilateral.
  std::size_t first_face(std::size_t face) const;
  std::size_t face_of(std::size_t mesh_face) const { return face_of_.empty() ? mesh_face : face_of_[mesh_face]; }
  std::span<const VertexIndex> face_nodes(std::size_t face, std::array<VertexIndex, 6>& room) const;

  /// Members of a part of elements or faces as cells or faces here, ascending, each once.
  std::vector<std::uint32_t> members(const Part& part) const;

 private:
  const MeshParts& mesh_;
  std::array<std::size_t, kKinds> end_{};
  std::vector<TetIndex> tets_;            ///< that are cells; empty: all
  std::vector<std::uint32_t> wide_;       ///< pyramids, then wedges, among the wide cells of the mesh
  std::vector<std::uint32_t> cell_of_;    ///< per tetrahedron
  std::vector<std::uint32_t> triangles_;  ///< that are faces; empty: all
  std::vector<std::uint32_t> face_of_;    ///< per face of the mesh
};

}  // namespace octafront::io
