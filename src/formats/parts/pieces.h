#pragma once

#include <octafront/mesh_field.h>
#include <octafront/tet_mesh.h>

#include "base/core/groups.h"
#include "base/shared/comm.h"
#include "formats/parts/division.h"
#include "formats/parts/mesh_parts.h"
#include "formats/parts/mixed_cells.h"

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace octafront::io {

/// The number of a point, cell, face or edge in the whole mesh.
using GlobalId = std::uint64_t;

/// One part of a mesh and one layer of elements around it, ghosts: those of other parts that share a corner with one of
/// its own. A face or edge comes along with the one element that it belongs to (MeshParts::sides(); of an edge the
/// first one there is), and is of that element's part. Numbers, names, labels and sets are those of the whole, in which
/// all points, cells, faces and edges are numbered as MixedCells does. What a process of several would hold.
struct Piece {
  std::uint32_t number = 0, parts = 1;
  /// Points, faces and edges in the order of the whole; tetrahedra too, the part's own before the ghosts. Its boundary
  /// and interfaces are such of the whole: where it was cut off it has no faces.
  TetMesh mesh;
  std::size_t own_tets = 0;
  std::size_t last_points = 0;                                    ///< as MeshParts::Hidden has them
  std::vector<GlobalId> point_ids, cell_ids, face_ids, edge_ids;  ///< cells: per tetrahedron
  std::vector<std::uint32_t> tet_part, point_part, edge_part;     ///< points: the lowest part that has it
  std::vector<MeshField> fields;
};

/// How many cells, faces and edges a whole mesh has, by MixedCells.
struct WholeCounts {
  GlobalId points = 0, cells = 0, faces = 0, edges = 0;
};

/// The pieces of a divided mesh, one at a time: beside the mesh it needs some 8 bytes for each element and those of the
/// piece that is made.
class Pieces {
 public:
  /// Refers to the mesh and fields. Throws OutputError if a face or edge belongs to no element.
  Pieces(const MeshParts& whole, Division division, std::span<const MeshField> fields = {});

  std::uint32_t count() const { return division_.parts; }
  const MeshParts& whole() const { return whole_; }
  const MixedCells& cells() const { return cells_; }
  const Division& division() const { return division_; }
  WholeCounts counts() const { return {whole_.points(), cells_.cells(), cells_.faces(), whole_.edges()}; }
  std::span<const MeshField> fields() const { return fields_; }

  /// O(piece), up to a logarithm. Not for several threads at a time: each piece is made by all of them.
  Piece piece(std::uint32_t number, bool with_ghosts = true);
  /// The elements of a part, ascending.
  std::span<const TetIndex> own_tets(std::uint32_t number) const { return own_[number]; }
  /// Those of other parts that share a corner with them, ascending; of a wedge or pyramid all.
  std::vector<TetIndex> ghosts_of(std::uint32_t number);

 private:
  /// The element that a face or edge belongs to, and its number.
  using Item = std::pair<TetIndex, std::uint32_t>;

  std::span<const VertexIndex> nodes_behind_corners(std::size_t t) const;
  void find_rims();
  void find_faces();
  void find_edges();
  void complete_wide_cells(std::vector<TetIndex>& tets) const;
  std::vector<std::uint32_t> items_of(std::span<const std::uint32_t> own, const std::vector<Item>& by_tet,
                                      std::span<const TetIndex> ghosts) const;
  std::vector<VertexIndex> points_of(std::span<const TetIndex> tets);
  void add_fields(Piece& piece, std::span<const TetIndex> tets) const;

  const MeshParts& whole_;
  const TetMesh& mesh_;
  MixedCells cells_;
  Division division_;
  std::span<const MeshField> fields_;
  Groups<> own_, own_faces_, own_edges_;  ///< of each part
  std::vector<std::uint32_t> point_part_;
  std::vector<std::uint32_t> place_;  ///< per point: in star_; kNone: it is in one part only
  Groups<> star_;                     ///< the tetrahedra at each corner in several parts
  std::vector<Item> faces_, edges_;   ///< ascending
  std::vector<TetIndex> edge_tet_;
  std::vector<VertexIndex> local_;  ///< per point its number in the piece that is being made; kNone
};

/// The piece of a rank, of a mesh that several have in shares (base/shared): its own tetrahedra and one layer of those
/// of others, which the ranks tell each other. Points that only ghosts have may be said to be of another part than the
/// lowest one, never of this one. Called by all ranks. Of a mesh of first order without wedges, pyramids, interfaces
/// and sets.
Piece piece_of_share(const TetMesh& share, const Comm& comm);

/// What the whole mesh has.
WholeCounts counts_of_shares(const TetMesh& share, const Comm& comm);

}  // namespace octafront::io
