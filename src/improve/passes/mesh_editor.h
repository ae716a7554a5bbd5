#pragma once

// Walks through a mesh, and changes of its connections.

#include "base/core/flat_map.h"
#include "improve/shape/edit_mesh.h"

#include <span>
#include <utility>
#include <vector>

namespace octafront::improve {

class MeshEditor {
 public:
  explicit MeshEditor(EditMesh& mesh) : mesh_(mesh), complex_(mesh.complex_) {}

  EditMesh& mesh() { return mesh_; }

  /// The tet behind a half-face; kNone if there is none.
  TetIndex behind(HalfFace h) const {
    const HalfFace o = complex_.across[h];
    return is_outside(o) ? kNone : o / 4;
  }

  /// The half-faces opposite v of the tets around it; boundary faces at v are not among them.
  void star(VertexIndex v, std::vector<HalfFace>& faces);

  /// The tets around the edge between corners i and j of t, from t on.
  void edge_ring(TetIndex t, int i, int j, EdgeRing& out);

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

  /// Puts new tets in place of old ones that fill the same space. Returns where they are: `created` in order. False,
  /// and nothing done, if an interface lies between two of the old ones. Requires: same outer faces, or those that
  /// differ named in `change`; shapes as of the new ones; one region.
  bool replace(std::span<const TetIndex> old_tets, std::span<const Tet> new_tets, std::span<const Shape> shapes,
               std::vector<TetIndex>& created, const BoundaryChange* change = nullptr);

  /// A new vertex inside, to be used by the next replace().
  VertexIndex add_vertex(Vec3 p);

 private:
  void note_gone(TetIndex t);
  bool have_both_sides(std::span<const TetIndex> tets);
  TetIndex slot();
  void change_boundary(const BoundaryChange& change);

  EditMesh& mesh_;
  TetComplex& complex_;
  TetRim rim_;
  std::vector<Triangle> parted_;
  FlatSet<TetIndex> seen_;
};

}  // namespace octafront::improve
