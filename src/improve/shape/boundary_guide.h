#pragma once

// Where vertices of the boundary may go: along the input's patches and curves, as near to it as
// before, with no force against its walls (input_force), off no flat wall (flat_walls), within interfaces
// (slide_interfaces).

// Where the vertices and edges of the boundary may go: vertices inside patches along the input surface, those of
// feature curves along their curve, corners nowhere. Every change is judged by how true to the input it leaves the
// boundary.

#include "base/geometry/nearby_triangles.h"
#include "improve/shape/boundary_ground.h"
#include "improve/shape/boundary_input.h"
#include "improve/shape/edit_mesh.h"

#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace octafront::improve {

class BoundaryGuide {
 public:
  /// Vertices listed in `frozen` stay where they are, too. `ground`: of the same
  /// surface; null: made here.
  BoundaryGuide(const EditMesh& mesh, const BoundaryInput& input, const std::vector<VertexIndex>& frozen,
                std::shared_ptr<const BoundaryGround> ground = nullptr);

  enum class Kind : std::uint8_t { kInner, kSurface, kCurve, kFixed };
  Kind kind(VertexIndex v) const { return v < kind_.size() ? kind_[v] : Kind::kInner; }
  /// Neither inner nor fixed.
  bool may_slide(VertexIndex v) const { return kind(v) == Kind::kSurface || kind(v) == Kind::kCurve; }
  /// True if neither the vertex nor an edge around it may change.
  bool is_frozen(VertexIndex v) const { return v < frozen_.size() && frozen_[v] != 0; }
  bool is_pinned(VertexIndex v) const { return v < pinned_.size() && pinned_[v] != 0; }
  /// True if the boundary edge may turn as far as features and patches go.
  bool may_turn(VertexIndex a, VertexIndex b) const;
  bool is_feature_edge(VertexIndex a, VertexIndex b) const;
  /// All of them, smaller index first, sorted.
  const std::vector<Edge>& feature_edges() const { return feature_edges_; }
  /// A vertex of a curve has gone to another of that curve.
  void merge_curve(VertexIndex gone, VertexIndex onto);
  double tolerance() const { return input_.tolerance; }
  /// How far the boundary may stray around p: by the tolerance, and by the leeway there.
  double tolerance_at(Vec3 p) const { return ground_->leeway.at(p, input_.tolerance); }
  /// Whether a place for a vertex of the boundary lies within `limit` of the surface or curve that the vertex is on; of
  /// a corner, of where it was.
  bool is_near_home(VertexIndex v, Vec3 place, double limit) const;
  const BoundaryInput& input() const { return input_; }

  const SurfaceMesh& surface() const { return input_.surface; }
  const TriangleTree& tree() const { return input_.tree; }
  const FeatureCurves& curves() const { return ground_->curves; }
  const BoundaryGround& ground() const { return *ground_; }

  /// How triangles of the boundary lie to the input, at the worst of them.
  struct Truth {
    double squared_distance = 0;  ///< of their centroids: on a smooth surface the sag there is the largest
    double cosine = 1;            ///< of their angle with the input beneath the centroid
  };
  /// `nearby`: what of the input is around, where that was gathered.
  Truth truth_of(std::span<const TriangleCorners> triangles, const NearbyTriangles* nearby = nullptr) const;
  /// How far triangles of this size around p may lie from the input whatever they did before; input units.
  double near_at(Vec3 p, double edge) const;
  /// True if triangles of which one would lie so are true, `near` as near_at() says.
  static bool is_true(const Truth& truth, double near);
  /// True if triangles that lie like `has` may replace those that lie like `had`: they are true, or no worse.
  static bool keeps_truth(const Truth& had, const Truth& has, double near);
  /// The same for the triangles themselves.
  bool keeps_truth(std::span<const TriangleCorners> before, std::span<const TriangleCorners> after) const;

 private:
  void freeze_where_regions_meet(const EditMesh& mesh);
  void freeze_where_boundary_touches_itself(const EditMesh& mesh);
  std::vector<Kind> kind_;
  std::vector<std::uint8_t> frozen_, pinned_;
  std::vector<std::pair<VertexIndex, Vec3>> fixed_;  ///< vertices that do not slide, and where they were; sorted
  std::vector<Edge> feature_edges_;                  ///< smaller index first, sorted
  BoundaryInput input_;
  std::shared_ptr<const BoundaryGround> ground_;
};

/// The boundary triangles around one vertex, and the vertex's freedom to move. One for each worker.
class SlidingVertex {
 public:
  SlidingVertex(const EditMesh& mesh, const BoundaryGuide& guide) : mesh_(mesh), guide_(guide) {}

  /// False if the vertex cannot slide after all. `star` as from EditMesh::star().
  bool load(VertexIndex v, std::span<const HalfFace> star);
  /// Unit vectors along which it may go: two in the tangent plane or one along its curve.
  std::span<const Vec3> axes() const { return {axes_.data(), axes_count_}; }
  /// Puts a place near the vertex back on the surface or curve; false if it would leave its patch or its sheet.
  bool snap(Vec3& place) const;
  /// True if the boundary stays true with the vertex at a place that snap() gave.
  bool keeps_truth(Vec3 place) const;

 private:
  bool load_curve();
  const NearbyTriangles& nearby() const;
  double near_limit() const;

  const EditMesh& mesh_;
  const BoundaryGuide& guide_;
  BoundaryGuide::Kind kind_ = BoundaryGuide::Kind::kFixed;
  Vec3 at_, normal_;
  std::uint32_t patch_ = 0;
  std::array<Vec3, 2> axes_;
  std::size_t axes_count_ = 0;
  FeatureCurves::Place on_curve_;
  std::vector<TriangleCorners> triangles_;           ///< corner 0 is the vertex
  double edge_ = 0;                                  ///< mean length of the boundary edges around it
  mutable std::optional<double> near_;               ///< near_at() there, once that was asked for
  mutable std::optional<BoundaryGuide::Truth> had_;  ///< as the triangles lie now, once that was asked for
  mutable std::vector<TriangleCorners> moved_;
  mutable bool gathered_ = false;
  mutable NearbyTriangles nearby_;  ///< once it was asked for
};

}  // namespace octafront::improve
