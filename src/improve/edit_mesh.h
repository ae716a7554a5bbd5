#pragma once

// A tetrahedral mesh that can be changed in place: half-face neighbours, a tetrahedron of each vertex, a free list.
// Taken from a TetMesh and given back to it; boundary triangles keep their number, patch and source throughout. Inside,
// vertices and tets are numbered along a space-filling curve, for the cache. Vertices move here; connections are walked
// and changed by way of an EditBlock (edit_block.h).

#include <octafront/tet_mesh.h>

#include "improve/shape.h"

#include <span>
#include <vector>

namespace octafront::improve {

/// Face i of tet t (opposite corner i) as one number, 4 t + i.
using HalfFace = std::uint32_t;

/// Across a boundary face lies kFirstBoundary + number of the boundary triangle. Below it there is room for the
/// half-faces of 7 * 2^27 tetrahedra: kMostTetsToImprove (mesh/index_range.h), and as many new ones as passes reserve.
inline constexpr HalfFace kFirstBoundary = 0xE0000000u;
inline constexpr bool is_boundary(HalfFace across) {
  return across >= kFirstBoundary;
}

/// What lies across a face between two regions: such faces are kept like those of the boundary.
inline constexpr HalfFace kBetweenRegions = kNone - 1;

/// The tetrahedra around an edge, in order, with the other two corners of each.
struct EdgeRing {
  std::vector<TetIndex> tets;
  /// Corners around the edge (a, b), counter-clockwise seen from b: tet k is positive as (a, b, ring[k], ring[k + 1]).
  /// As many as tets if closed, one more if the edge lies on the boundary.
  std::vector<VertexIndex> ring;
  bool closed = true;
};

class EditMesh {
 public:
  /// Requires a valid mesh. Throws MeshingError if there are more than kMostTetsToImprove, or if faces do not match
  /// (with their corners).
  explicit EditMesh(TetMesh&& mesh, ImproveOptions::Objective objective = ImproveOptions::Objective::kBalanced);

  /// The mesh back, compacted: vertices in the order they came in, without unused ones, new ones behind; tets in order
  /// of space.
  TetMesh release();

  /// What the scores of the shapes say.
  ImproveOptions::Objective objective() const { return objective_; }
  std::size_t slots() const { return tets_.size(); }
  std::size_t vertices() const { return points_.size(); }
  std::size_t live_tets() const { return tets_.size() - free_.size(); }
  bool alive(TetIndex t) const { return tets_[t][0] != kNone; }
  const Tet& tet(TetIndex t) const { return tets_[t]; }
  Vec3 point(VertexIndex v) const { return points_[v]; }
  const Shape& shape(TetIndex t) const { return shapes_[t]; }
  HalfFace across(HalfFace h) const { return across_[h]; }
  bool on_boundary(VertexIndex v) const { return on_boundary_[v] != 0; }
  /// Any tet at v; kNone if v is no longer used.
  TetIndex tet_of(VertexIndex v) const { return tet_of_[v]; }

  /// Patch of the boundary triangle that lies across (see across()).
  std::uint32_t boundary_patch(HalfFace across) const {
    if (across == kBetweenRegions) return kNone;
    return rest_.patch.empty() ? 0 : rest_.patch[across - kFirstBoundary];
  }
  /// For each vertex of the mesh that was taken, its number here.
  std::vector<VertexIndex> numbers_here() const;

  /// Corner of t at which v lies. Requires that it does.
  int corner_of(TetIndex t, VertexIndex v) const {
    const Tet& c = tets_[t];
    return c[0] == v ? 0 : c[1] == v ? 1 : c[2] == v ? 2 : 3;
  }

  /// Moves a vertex and sets the shapes of its star (faces as from star(), shapes in the same order).
  void move(VertexIndex v, Vec3 to, std::span<const HalfFace> star_faces, const ShapeBatch& shapes);

  /// Worst of each measure over the mesh.
  Floor floor() const;
  /// Sum of beta over the mesh, in a fixed order.
  double beta_sum() const;

  /// t is worse than `than`; of equals, the one with the lower number.
  bool worse(TetIndex t, TetIndex than) const {
    const float a = shapes_[t].score, b = shapes_[than].score;
    return a != b ? a < b : t < than;
  }

 private:
  friend class EditBlock;
  friend class EditBlocks;

  /// More slots, on top of the free lists, the first ones uppermost.
  void reserve_tets(std::size_t more);
  void reserve_points(std::size_t more);
  void take(TetMesh& mesh);
  void part(HalfFace h, HalfFace other);
  void connect();
  void compute_shapes();

  ImproveOptions::Objective objective_;
  std::vector<Vec3> points_;
  std::vector<Tet> tets_;
  std::vector<HalfFace> across_;
  std::vector<Shape> shapes_;
  std::vector<std::uint32_t> region_;
  std::vector<TetIndex> tet_of_;
  std::vector<std::uint8_t> on_boundary_;
  std::vector<TetIndex> free_;            ///< slots of no tet
  std::vector<VertexIndex> free_points_;  ///< numbers of no vertex, behind those that were taken
  std::vector<VertexIndex> key_;          ///< for each vertex: a number that grows along the space-filling curve
  std::vector<VertexIndex> original_;     ///< the number of each vertex in the mesh that was taken
  TetMesh rest_;                          ///< boundary, patches, sources, names: carried through
  bool had_regions_ = false;

  mutable std::vector<std::uint32_t> tet_mark_;
  mutable std::uint32_t mark_ = 0;
};

}  // namespace octafront::improve
