#pragma once

#include <octafront/mesh_field.h>

#include "formats/parts/mesh_parts.h"
#include "formats/parts/wide_orders.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace octafront::io {

/// The elements and faces of a mesh for formats that have wedges, pyramids and quadrilaterals: tetrahedra that are
/// part of none first, then pyramids, then wedges; triangles, then quadrilaterals. Without wide cells they are the
/// tetrahedra and faces of the mesh, under their numbers. Refers to the mesh.
class MixedCells {
 public:
  enum Kind : std::size_t { kTet, kPyramid, kWedge, kKinds };
  static constexpr std::array kAllKinds{kTet, kPyramid, kWedge};

  explicit MixedCells(const MeshParts& mesh);

  std::size_t cells() const { return end_[kWedge]; }
  /// Of the cells of a kind.
  std::size_t begin(Kind kind) const { return kind == kTet ? 0 : end_[kind - 1]; }
  std::size_t end(Kind kind) const { return end_[kind]; }
  Kind kind(std::size_t cell) const { return cell < end_[kTet] ? kTet : cell < end_[kPyramid] ? kPyramid : kWedge; }
  std::size_t nodes_per(Kind kind) const;
  /// The first tetrahedron of a cell.
  TetIndex first_tet(std::size_t cell) const;
  std::size_t cell_of(TetIndex tet) const { return cell_of_.empty() ? tet : cell_of_[tet]; }
  /// Of a tetrahedron as MeshParts has them; of a pyramid or wedge in the order of kPlainWide, or the one given.
  std::span<const VertexIndex> nodes(std::size_t cell, CellRoom& room, const WideOrder& order = kPlainWide) const;
  /// One of them.
  VertexIndex node(std::size_t cell, std::size_t k, const WideOrder& order = kPlainWide) const;
  const WideCell& wide(std::size_t cell) const { return mesh_.mesh().wide_cells[wide_[cell - end_[kTet]]]; }
  /// The side of a pyramid or wedge that a face is: its place in kPyramidFaces or kWedgeFaces.
  std::size_t side_of(std::size_t cell, std::size_t face) const;

  std::size_t faces() const { return triangles() + quads(); }
  std::size_t triangles() const { return mesh_.faces() - 2 * quads(); }
  std::size_t quads() const { return mesh_.faces() == 0 ? 0 : mesh_.wide_faces().size(); }
  std::size_t nodes_per_quad() const { return mesh_.second_order() ? 8 : 4; }
  /// The face of the mesh that a triangle is, or the first one of a quadrilateral.
  std::size_t first_face(std::size_t face) const;
  std::size_t face_of(std::size_t mesh_face) const { return face_of_.empty() ? mesh_face : face_of_[mesh_face]; }
  /// Corners, then mid-side nodes 12 23 31, of a quadrilateral 12 23 34 41.
  std::span<const VertexIndex> face_nodes(std::size_t face, FaceRoom& room) const;
  VertexIndex face_node(std::size_t face, std::size_t k) const;

  /// How many points or cells a field has values for; value k of one of them: a cell has that of its first tetrahedron.
  std::size_t items(const MeshField& field) const { return field.of_elements ? cells() : mesh_.points(); }
  double value_of(const MeshField& field, std::size_t item, std::size_t k) const {
    return field.values[(field.of_elements ? first_tet(item) : item) * field.components + k];
  }

  /// Members of a part of elements or faces as cells or faces here, ascending, each once; of others as they are.
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

/// A mesh of second order as files with wedges and pyramids have it: these have no mid-side nodes on the diagonals of
/// their quadrilaterals.
struct WithoutDiagonals {
  std::optional<TetMesh> mesh;  ///< with its points in another order, that they come last; empty: they do anyhow
  std::size_t diagonals = 0;    ///< how many points that is
};
WithoutDiagonals without_diagonals(const TetMesh& mesh);

}  // namespace octafront::io
