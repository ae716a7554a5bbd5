#pragma once

// A tetrahedral mesh that can be changed in place: a TetComplex, with the places of the vertices and what its elements
// are worth. Taken from a TetMesh and given back to it; boundary triangles keep their number, patch and source
// throughout, as long as they are there. Inside, vertices and tets are numbered along a space-filling curve, for the
// cache. Vertices move here; connections are walked and changed by way of an EditBlock (edit_block.h).

#include <octafront/tet_mesh.h>

#include "base/blocks/blocks.h"
#include "base/mesh/tet_complex.h"
#include "base/mesh/tet_key.h"
#include "improve/shape/shape.h"

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace octafront::improve {

/// What lies across a face between two regions: such faces are kept like those of the boundary. Across those lies
/// kFirstOutside + the number of the boundary triangle.
inline constexpr HalfFace kBetweenRegions = kNone - 1;

class EditMesh {
 public:
  /// Requires a valid mesh. Throws MeshingError if there are more than kMostTetsToImprove, or if faces do not match
  /// (with their corners).
  explicit EditMesh(TetMesh&& mesh, ImproveOptions::Objective objective = ImproveOptions::Objective::kBalanced);

  /// From here on what edits replace is written down, so that taken() can give the mesh back as it was.
  void remember();
  /// The mesh as remember() found it, tets by their names; this one is of no use any more.
  TetMesh taken();
  /// Where vertices were then.
  std::span<const Vec3> points_taken() const { return taken_->points; }
  /// Whether the boundary is another one than then.
  bool moved_boundary() const;

  /// The mesh back, compacted: vertices in the order they came in, without unused ones, new ones behind; tets in order
  /// of space, by their names; boundary triangles by their numbers, the last ones in the place of those that went.
  TetMesh release();
  /// For each vertex of the mesh that release() is to give, its number in the mesh that was taken, or kNone if new.
  std::vector<VertexIndex> numbers_taken() const;

  /// What the scores of the shapes say.
  ImproveOptions::Objective objective() const { return objective_; }
  std::size_t slots() const { return complex_.tets.size(); }
  std::size_t vertices() const { return points_.size(); }
  std::size_t live_tets() const { return complex_.tets.size() - complex_.free.size(); }
  bool alive(TetIndex t) const { return complex_.alive(t); }
  const Tet& tet(TetIndex t) const { return complex_.tets[t]; }
  Vec3 point(VertexIndex v) const { return points_[v]; }
  const Shape& shape(TetIndex t) const { return shapes_[t]; }
  HalfFace across(HalfFace h) const { return complex_.across[h]; }
  bool on_boundary(VertexIndex v) const { return on_boundary_[v] != 0; }

  /// Patch of the boundary triangle that lies across (see across()).
  std::uint32_t boundary_patch(HalfFace across) const {
    if (across == kBetweenRegions) return kNone;
    return rest_.patch.empty() ? 0 : rest_.patch[across - kFirstOutside];
  }
  /// The triangles of the boundary, by number from 0: the surface that LiveTriangles looks at.
  std::size_t triangle_count() const { return rest_.boundary.size(); }
  bool is_removed(std::size_t triangle) const { return rest_.boundary[triangle][0] == kNone; }
  Triangle triangle(std::size_t t) const { return rest_.boundary[t]; }
  Vec3 corner(std::size_t t, int i) const { return points_[rest_.boundary[t][i]]; }
  /// The number that a vertex had in the mesh that was taken. Requires that it was there.
  VertexIndex number_taken(VertexIndex v) const { return original_[v]; }
  /// Vertices from here on are new; the others are numbered along the curve of the first stage's cells.
  std::size_t vertices_taken() const { return original_.size(); }
  /// For each vertex of the mesh that was taken, its number here.
  std::vector<VertexIndex> numbers_here() const;

  /// The vertices by cells, from where they were at the beginning; a new one is in those of one beside it.
  const Cells& cells(int stage) const { return cells_[stage]; }

  bool has(TetIndex t, VertexIndex v) const { return complex_.has(t, v); }
  /// Corner of t at which v lies. Requires that it does.
  int corner_of(TetIndex t, VertexIndex v) const { return complex_.corner_of(t, v); }

  /// Moves a vertex and sets the shapes of its star (faces as from star(), shapes in the same order).
  void move(VertexIndex v, Vec3 to, std::span<const HalfFace> star_faces, const ShapeBatch& shapes);

  /// The first thing that is wrong: in the complex, across a boundary face, a tet that is not positive, a shape that is
  /// not that of its tet.
  std::optional<std::string> first_inconsistency() const;
  /// Looks at these tets only.
  std::optional<std::string> first_inconsistency(std::span<const TetIndex> touched) const;

  /// Worst of each measure over the mesh.
  Floor floor() const;
  double mean_beta() const;

  /// t is worse than `than`; of equals, the one whose name comes first.
  bool worse(TetIndex t, TetIndex than) const {
    const float a = shapes_[t].score, b = shapes_[than].score;
    return a != b ? a < b : tet_key(tet(t)) < tet_key(tet(than));
  }

  /// In ascending order of their names. Whatever is worked on one after the other, or added up, is so in this order:
  /// slots are places, which tet lies in which says nothing.
  void sort_by_name(std::span<TetIndex> tets) const;
  /// The same for half-faces opposite one vertex.
  void sort_star(std::span<HalfFace> star) const;

 private:
  friend class EditBlock;
  friend class EditBlocks;
  friend class EditMeshShuffle;  ///< of the tests

  /// More slots, on top of the free lists, the first ones uppermost.
  void reserve_tets(std::size_t more);
  void reserve_points(std::size_t more);
  void take(TetMesh& mesh);
  void divide_in_cells();
  std::optional<std::string> wrong_at_tet(TetIndex t) const;
  [[noreturn]] void throw_unmatched(HalfFace h) const;
  void part(HalfFace h, HalfFace other);
  void connect();
  static void drop_removed_triangles(TetMesh& mesh);
  void compute_shapes();

  /// What edits have replaced, and where vertices were.
  struct Taken {
    std::vector<Vec3> points;
    std::vector<std::uint8_t> is_there;  ///< per slot: whether its tet was there
    std::vector<Tet> gone;
    std::vector<std::uint32_t> region_of_gone;
    TetMesh rest;
  };

  ImproveOptions::Objective objective_;
  TetComplex complex_;  ///< without marks
  std::vector<Vec3> points_;
  std::vector<Shape> shapes_;
  std::vector<std::uint32_t> region_;  ///< per slot; empty if there were none
  std::vector<std::uint8_t> on_boundary_;
  std::vector<VertexIndex> free_points_;  ///< numbers of no vertex, behind those that were taken
  std::array<Cells, kCellStages> cells_;
  std::vector<VertexIndex> original_;  ///< the number of each vertex in the mesh that was taken
  TetMesh rest_;                       ///< boundary, patches, sources, names: carried through; no tets, no points
  bool had_regions_ = false;
  std::optional<Taken> taken_;
};

/// Of its elements.
float worst_score(const TetMesh& mesh, ImproveOptions::Objective objective);

}  // namespace octafront::improve
