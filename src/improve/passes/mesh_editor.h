#pragma once

// Walks through a mesh, and changes of its connections.

#include "base/core/flat_map.h"
#include "improve/shape/edit_mesh.h"

#include <span>
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

  /// The tets around the edge between corners i and j of t, from t on if the ring is closed.
  void edge_ring(TetIndex t, int i, int j, EdgeRing& out) const {
    complex_.whole_ring(t, i, j, out, [](TetIndex) { return true; });
  }

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

  /// Tets that fill the space of others, and their shapes.
  struct Refill {
    std::vector<TetIndex> old_tets;
    std::vector<Tet> new_tets;
    std::vector<Shape> shapes;

    void clear() { old_tets.clear(), new_tets.clear(), shapes.clear(); }
    void add(const Tet& tet, const Shape& shape) { new_tets.push_back(tet), shapes.push_back(shape); }
  };
  /// Puts the new tets in place of the old ones; they are in created(), in order. False, and nothing done, if an
  /// interface lies between two of the old ones. Requires: same outer faces, or those that differ named in `change`;
  /// one region.
  bool replace(const Refill& refill, const BoundaryChange* change = nullptr);
  /// The same by the star of a new vertex inside, as evaluated: `faces` of old tets, one for each element of the star.
  bool replace_by_star(std::span<const TetIndex> old_tets, std::span<const Triangle> faces, const ShapeBatch& star,
                       Vec3 apex);
  const std::vector<TetIndex>& created() const { return created_; }

  /// Whether a tet of this shape may be made: above the floor, and positive by exact sign where that is not certain.
  bool is_usable(const Tet& t, const Shape& shape, const Floor& floor) const;

 private:
  void note_gone(TetIndex t);
  bool have_both_sides(std::span<const TetIndex> tets);
  TetIndex slot();
  void change_boundary(const BoundaryChange& change);
  VertexIndex add_vertex(Vec3 p);

  EditMesh& mesh_;
  TetComplex& complex_;
  TetRim rim_;
  std::vector<Triangle> parted_;
  FlatSet<TetIndex> seen_;
  std::vector<TetIndex> created_;
};

}  // namespace octafront::improve
