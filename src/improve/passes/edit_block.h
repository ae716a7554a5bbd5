#pragma once

// The part of a mesh that one worker may look at and change while others work on theirs: the tetrahedra all of whose
// vertices lie in one cell of a stage (base/blocks). No two blocks share such a tetrahedron,
// or the corners of one. A search that leaves the block gives up and says so; slots for new tets and vertices are
// reserved beforehand. A block may also be the whole mesh; then nothing is refused, and the mesh grows as it must.

#include "base/core/flat_map.h"
#include "improve/shape/edit_mesh.h"

#include <span>
#include <utility>
#include <vector>

namespace octafront::improve {

class EditBlock {
 public:
  /// All of the mesh.
  explicit EditBlock(EditMesh& mesh) : mesh_(mesh), complex_(mesh.complex_), whole_(true) {}
  /// The vertices of one cell, and slots that may be used.
  EditBlock(EditMesh& mesh, const Cells& cells, std::uint32_t cell, std::vector<TetIndex> free_tets,
            std::vector<VertexIndex> free_points);

  EditMesh& mesh() { return mesh_; }

  /// True if the tet, which must be alive, may be changed.
  bool owns(TetIndex t) const {
    if (whole_) return true;
    for (const VertexIndex v : complex_.tets[t])
      if (cells_->of[v] != cell_) return false;
    return true;
  }

  /// True if one of the searches since the last call left the block.
  bool take_cut() { return std::exchange(cut_, false); }

  /// The tet behind a half-face of a tet of the block; kNone if there is none, or another's.
  TetIndex behind(HalfFace h) {
    const HalfFace o = complex_.across[h];
    return is_outside(o) || !allowed(o / 4) ? kNone : o / 4;
  }

  /// The half-faces opposite v of the tets around it, by the names of these unless they are too many to be worked on
  /// (EditMesh::sort_star); boundary faces at v are not among them. False if one of the tets is not the block's.
  bool star(VertexIndex v, std::vector<HalfFace>& faces);

  /// The tets around the edge between corners i and j of t, from t on. False if one of them is not the block's.
  bool edge_ring(TetIndex t, int i, int j, EdgeRing& out);

  /// The same, but gives up, false, once the ring is known to be open, to have more than `longest` tets, or to have a
  /// tet that is worse than t.
  bool edge_ring_where_worst(TetIndex t, int i, int j, std::size_t longest, EdgeRing& out);

  /// Boundary triangles that take the place of others: numbers as across() gives them, corners counter-clockwise seen
  /// from outside. Those that are made carry numbers of some that go, and their patches.
  struct BoundaryChange {
    struct NewTriangle {
      HalfFace number;
      Triangle corners;
    };
    std::vector<HalfFace> gone;
    std::vector<NewTriangle> made;
  };

  /// Puts new tets in place of old ones of the block that fill the same space. Returns where they are: `created` in
  /// order. False, and nothing done, if there are too few slots left, or an interface lies between two of the old ones.
  /// Requires: same outer faces, or those that differ
  /// named in `change`; shapes as of the new ones; one region.
  bool replace(std::span<const TetIndex> old_tets, std::span<const Tet> new_tets, std::span<const Shape> shapes,
               std::vector<TetIndex>& created, const BoundaryChange* change = nullptr);

  /// A new vertex inside, near `beside`, to be used by the next replace(); kNone if there is no slot left, for it or
  /// for `tets` more.
  VertexIndex add_vertex(Vec3 p, VertexIndex beside, std::size_t tets);

 private:
  friend class EditBlocks;

  bool allowed(TetIndex t) {
    if (owns(t)) return true;
    cut_ = true;
    return false;
  }
  void note_gone(TetIndex t);
  std::vector<TetIndex>& free_tets() { return whole_ ? complex_.free : free_tets_; }
  bool have_both_sides(std::span<const TetIndex> tets);
  bool has_room(std::size_t tets) { return whole_ || free_tets_.size() >= tets; }
  TetIndex slot();
  void change_boundary(const BoundaryChange& change);

  EditMesh& mesh_;
  TetComplex& complex_;
  TetRim rim_;
  std::vector<Triangle> parted_;
  bool whole_ = false, cut_ = false;
  const Cells* cells_ = nullptr;
  std::uint32_t cell_ = 0;
  FlatSet<TetIndex> seen_;
  std::vector<Tet> gone_;  ///< what EditMesh::remember() asks for
  std::vector<std::uint32_t> region_of_gone_;
  std::vector<TetIndex> free_tets_;
  std::vector<VertexIndex> free_points_;
};

}  // namespace octafront::improve
