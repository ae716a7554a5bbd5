#pragma once

// A tetrahedral mesh that can be changed in place: a TetComplex, with the places of the vertices and what its elements
// are worth. Taken from a TetMesh and given back to it; boundary triangles keep their number, patch and source
// throughout, as long as they are there, vertices theirs. Vertices move here; connections are walked and changed by way
// of a MeshEditor (mesh_editor.h).

#include <octafront/tet_mesh.h>

#include "base/core/groups.h"
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
  /// Whether faces may be neither shared nor on the boundary: of a part of a mesh, kept like those between regions.
  enum class Rim { kNone, kHeld };

  /// Requires a valid mesh. Throws MeshingError if there are more than kMostTetsToImprove, or if faces do not match
  /// (with their corners).
  explicit EditMesh(TetMesh&& mesh, ImproveOptions::Objective objective = ImproveOptions::Objective::kBalanced,
                    Rim rim = Rim::kNone);

  /// From here on what edits replace is written down, for change().
  void remember();
  struct Moved {
    VertexIndex vertex;
    Vec3 to;
  };
  struct ChangedTriangle {
    std::uint32_t number;
    Triangle corners;  ///< kNone: it is gone
  };
  /// What became of the mesh since remember(), in the numbers of what was taken; new vertices follow those.
  struct Change {
    std::vector<Moved> moved;  ///< vertices that were taken
    std::vector<Vec3> added;   ///< vertices
    std::vector<TetIndex> gone;
    std::vector<Tet> made;
    std::vector<std::uint32_t> region_of_made;
    std::vector<ChangedTriangle> boundary;
  };
  Change change() const;

  /// The mesh back, compacted: vertices in the order they came in, without unused ones, new ones behind; tets by
  /// their keys; boundary triangles by their numbers, the last ones in the place of those that went.
  TetMesh release();

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

  /// t is worse than `than`; of equals, the one whose corners come first.
  bool worse(TetIndex t, TetIndex than) const {
    const float a = shapes_[t].score, b = shapes_[than].score;
    return a != b ? a < b : tet_key(tet(t)) < tet_key(tet(than));
  }

 private:
  friend class MeshEditor;

  /// More slots, on top of the free lists, the first ones uppermost.
  void reserve_tets(std::size_t more);
  void reserve_points(std::size_t more);
  void take(TetMesh& mesh);
  std::optional<std::string> wrong_at_tet(TetIndex t) const;
  [[noreturn]] void throw_unmatched(HalfFace h) const;
  void part(HalfFace h, HalfFace other);
  void connect();
  void compute_shapes();

  /// What edits have replaced, and where vertices were.
  struct Taken {
    std::vector<Vec3> points;
    std::vector<TetIndex> number;  ///< per slot: of its tet in the mesh that was taken; kNone: it was not there
    std::vector<TetIndex> gone;    ///< numbers
    std::vector<Triangle> boundary;
  };

  ImproveOptions::Objective objective_;
  Rim rim_;
  TetComplex complex_;  ///< without marks
  std::vector<Vec3> points_;
  std::vector<Shape> shapes_;
  std::vector<std::uint32_t> region_;  ///< per slot; empty if there were none
  std::vector<std::uint8_t> on_boundary_;
  std::vector<VertexIndex> free_points_;  ///< numbers of no vertex, behind those that were taken
  std::vector<TetIndex> numbers_;         ///< of the tets there
  TetMesh rest_;                          ///< all else: carried through; no tets, no points
  bool had_regions_ = false;
  std::optional<Taken> taken_;
};

/// Calls visit(t, shape) for the tets begin ... end - 1 that are there (first corner not kNone).
template <class Visit>
void for_each_shape(std::span<const Vec3> points, std::span<const Tet> tets, ImproveOptions::Objective objective,
                    std::size_t begin, std::size_t end, const Visit& visit) {
  ShapeBatch batch(objective);
  std::array<std::size_t, ShapeBatch::kBatch> number;
  const auto flush = [&] {
    batch.evaluate();
    for (int i = 0; i < batch.size; ++i) visit(number[i], batch.shape(i));
    batch.size = 0;
  };
  batch.size = 0;
  for (std::size_t t = begin; t < end; ++t) {
    const Tet& c = tets[t];
    if (c[0] == kNone) continue;
    number[batch.size] = t;
    batch.add(points[c[0]], points[c[1]], points[c[2]], points[c[3]]);
    if (batch.size == ShapeBatch::kBatch) flush();
  }
  flush();
}

/// The numbers of the tets that are there in ascending order of their keys.
Groups<> order_by_key(const std::vector<Tet>& tets, std::size_t vertices);
/// Boundary triangles whose first corner is kNone; the last ones come in their place, with all that hangs on them. Of a
/// mesh without points and tets.
void drop_removed_triangles(TetMesh& mesh);

/// Of its elements.
float worst_score(const TetMesh& mesh, ImproveOptions::Objective objective);

}  // namespace octafront::improve
