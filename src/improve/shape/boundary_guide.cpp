#include "improve/shape/boundary_guide.h"

#include <octafront/surface_mesh.h>

#include "base/geometry/measures.h"
#include "base/mesh/surface_topology.h"

#include <algorithm>
#include <cmath>

namespace octafront::improve {
namespace {

/// A boundary triangle this near to the input, in edge lengths, is as true as the size asks for: the chord of a circle
/// of 24 elements is .033 of its length away from it.
constexpr double kTrueToInput = 0.03;
/// Cosine of the angle between a boundary triangle and the input beneath it that is always allowed.
constexpr double kFacesAlike = 0.8;
/// A curve vertex farther from the input's curves than this, in edge lengths, belongs to none of them. Those of the
/// surface front lie on them to rounding; files round to seven digits.
constexpr double kOnCurve = 1e-3;
/// What of the input is gathered around a vertex, in edge lengths: centroids of its triangles, moved, and some more.
constexpr double kAround = 0.8;
/// How far the input is looked for among what was gathered, in edge lengths.
constexpr double kFirstLook = 0.1;
/// How far from the tangent plane the surface may lie, as a part of the step along it.
constexpr double kLeaves = 0.5;

Vec3 area_normal(const TriangleCorners& t) {
  return double_area_normal(t[0], t[1], t[2]);
}

}  // namespace

BoundaryGuide::BoundaryGuide(const EditMesh& mesh, const BoundaryInput& input, const std::vector<VertexIndex>& frozen,
                             std::shared_ptr<const BoundaryGround> ground)
    : kind_(mesh.vertices(), Kind::kInner),
      frozen_(mesh.vertices(), 0),
      pinned_(mesh.vertices(), 0),
      input_(input),
      ground_(ground ? std::move(ground) : std::make_shared<const BoundaryGround>(input)) {
  for (VertexIndex v = 0; v < kind_.size(); ++v)
    if (mesh.on_boundary(v)) kind_[v] = Kind::kSurface;
  std::vector<std::uint8_t> valence(kind_.size(), 0);
  for (const auto& [a, b] : input.of_mesh.edges) {
    feature_edges_.push_back(sorted_edge(a, b));
    for (const VertexIndex v : {a, b})
      if (valence[v] < 3) ++valence[v];
  }
  std::sort(feature_edges_.begin(), feature_edges_.end());
  for (VertexIndex v = 0; v < kind_.size(); ++v)
    if (valence[v] != 0) kind_[v] = valence[v] == 2 ? Kind::kCurve : Kind::kFixed;
  for (const VertexIndex v : input.of_mesh.corners) kind_[v] = Kind::kFixed;
  for (const VertexIndex v : frozen) frozen_[v] = 1;
  for (const VertexIndex v : input.frozen) frozen_[v] = 1;
  for (const VertexIndex v : input.pinned) pinned_[v] = 1;
  freeze_where_regions_meet(mesh);
  if (!input.surface.sides.empty()) freeze_where_boundary_touches_itself(mesh);
  for (VertexIndex v = 0; v < kind_.size(); ++v)
    if (frozen_[v]) kind_[v] = Kind::kFixed;
  for (VertexIndex v = 0; v < kind_.size(); ++v)
    if (kind_[v] == Kind::kFixed) fixed_.push_back({v, mesh.point(v)});
}

bool BoundaryGuide::is_near_home(VertexIndex v, Vec3 place, double limit) const {
  if (kind(v) == Kind::kSurface) return tree().is_within(place, limit);
  if (kind(v) == Kind::kCurve) return curves().nearest(place, limit).has_value();
  const auto home = std::lower_bound(fixed_.begin(), fixed_.end(), v,
                                     [](const auto& entry, VertexIndex key) { return entry.first < key; });
  return home != fixed_.end() && home->first == v && distance(home->second, place) <= limit;
}

void BoundaryGuide::freeze_where_regions_meet(const EditMesh& mesh) {
  for (HalfFace h = 0; h < 4 * mesh.slots(); ++h)
    if (mesh.across(h) == kBetweenRegions)
      for (const int corner : kTetFaces[h % 4]) frozen_[mesh.tet(h / 4)[corner]] = 1;
}

/// At edges with other than two triangles, and at vertices around which they do not hang together: who walks around
/// there sees a part of the elements only.
void BoundaryGuide::freeze_where_boundary_touches_itself(const EditMesh& mesh) {
  std::vector<Triangle> boundary;
  for (HalfFace h = 0; h < 4 * mesh.slots(); ++h) {
    if (!mesh.alive(h / 4) || !is_outside(mesh.across(h)) || mesh.across(h) == kBetweenRegions) continue;
    boundary.push_back(face_of(mesh.tet(h / 4), static_cast<int>(h % 4)));
  }
  const std::vector<std::uint8_t> touches =
      touching_vertices(boundary, make_edge_table(mesh.vertices(), boundary), mesh.vertices(), FansOver::kEdgesOfTwo);
  for (VertexIndex v = 0; v < touches.size(); ++v) frozen_[v] |= touches[v];
}

bool BoundaryGuide::may_turn(VertexIndex a, VertexIndex b) const {
  return !is_frozen(a) && !is_frozen(b) && !is_pinned(a) && !is_pinned(b) && !is_feature_edge(a, b);
}

bool BoundaryGuide::is_feature_edge(VertexIndex a, VertexIndex b) const {
  return std::binary_search(feature_edges_.begin(), feature_edges_.end(), sorted_edge(a, b));
}

void BoundaryGuide::merge_curve(VertexIndex gone, VertexIndex onto) {
  for (auto& [a, b] : feature_edges_) {
    if (a != gone && b != gone) continue;
    const Edge e = sorted_edge(a == gone ? onto : a, b == gone ? onto : b);
    a = e[0], b = e[1];
  }
  std::erase_if(feature_edges_, [](const Edge& e) { return e[0] == e[1]; });
  std::sort(feature_edges_.begin(), feature_edges_.end());
}

BoundaryGuide::Truth BoundaryGuide::truth_of(std::span<const TriangleCorners> triangles,
                                             const NearbyTriangles* nearby) const {
  Truth truth;
  for (const TriangleCorners& t : triangles) {
    const Vec3 middle = centroid(t[0], t[1], t[2]), n = area_normal(t);
    TriangleTree::Nearest below;
    if (nearby) below = nearby->nearest(middle, kFirstLook * kFirstLook * squared_distance(t[0], t[1]));
    if (below.triangle == kNone) below = tree().nearest(middle);
    const Vec3 m = area_normal(tree().corners(below.triangle));
    truth.squared_distance = std::max(truth.squared_distance, below.squared_distance);
    truth.cosine = std::min(truth.cosine, dot(n, m) / std::sqrt(squared_length(n) * squared_length(m)));
  }
  return truth;
}

double BoundaryGuide::near_at(Vec3 p, double edge) const {
  return ground_->leeway.at(p, kTrueToInput * edge);
}

bool BoundaryGuide::is_true(const Truth& truth, double near) {
  return truth.squared_distance <= near * near && truth.cosine >= kFacesAlike;
}

bool BoundaryGuide::keeps_truth(const Truth& had, const Truth& has, double near) {
  if (is_true(has, near)) return true;
  if (is_true(had, near)) return false;
  return has.squared_distance <= std::max(had.squared_distance, near * near) &&
         has.cosine >= std::min(had.cosine, kFacesAlike);
}

bool BoundaryGuide::keeps_truth(std::span<const TriangleCorners> before, std::span<const TriangleCorners> after) const {
  double edge = 0;
  for (const TriangleCorners& t : after) edge += distance(t[0], t[1]) / static_cast<double>(after.size());
  const Truth has = truth_of(after);
  const double near = near_at(after[0][0], edge);
  return is_true(has, near) || keeps_truth(truth_of(before), has, near);
}

bool SlidingVertex::load(VertexIndex v, std::span<const HalfFace> star) {
  if (guide_.is_pinned(v)) return false;
  kind_ = guide_.kind(v);
  at_ = mesh_.point(v);
  triangles_.clear();
  normal_ = {};
  axes_count_ = 0;
  edge_ = 0;
  had_.reset();
  near_.reset();
  bool one_patch = true;
  for (const HalfFace h : star) {
    const TetIndex t = h / 4;
    const int corner = static_cast<int>(h % 4);
    for (int i = 0; i < 4; ++i) {
      const HalfFace across = mesh_.across(4 * t + i);
      if (i == corner || !is_outside(across)) continue;
      const auto& f = kTetFaces[i];
      const int at = f[0] == corner ? 0 : f[1] == corner ? 1 : 2;
      const Tet& c = mesh_.tet(t);
      triangles_.push_back({at_, mesh_.point(c[f[(at + 1) % 3]]), mesh_.point(c[f[(at + 2) % 3]])});
      one_patch &= triangles_.size() == 1 || mesh_.boundary_patch(across) == patch_;
      patch_ = mesh_.boundary_patch(across);
      normal_ += area_normal(triangles_.back());
      edge_ += distance(at_, triangles_.back()[1]);
    }
  }
  if (triangles_.empty()) return false;
  edge_ /= static_cast<double>(triangles_.size());
  gathered_ = false;
  if (kind_ == BoundaryGuide::Kind::kCurve) return load_curve();
  normal_ = normalized(normal_);
  if (kind_ != BoundaryGuide::Kind::kSurface || !one_patch || squared_length(normal_) == 0) return false;
  const Vec3 aside = std::abs(normal_.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  axes_[0] = normalized(cross(normal_, aside));
  axes_[1] = cross(normal_, axes_[0]);
  axes_count_ = 2;
  return true;
}

bool SlidingVertex::load_curve() {
  const auto place = guide_.curves().nearest(at_, kOnCurve * edge_);
  if (!place) return false;
  on_curve_ = *place;
  axes_[0] = guide_.curves().tangent(on_curve_);
  axes_count_ = 1;
  return true;
}

const NearbyTriangles& SlidingVertex::nearby() const {
  if (!gathered_) nearby_.gather(guide_.tree(), at_, kAround * edge_);
  gathered_ = true;
  return nearby_;
}

double SlidingVertex::near_limit() const {
  if (!near_) near_ = guide_.near_at(at_, edge_);
  return *near_;
}

bool SlidingVertex::snap(Vec3& place) const {
  if (kind_ == BoundaryGuide::Kind::kCurve) {
    const auto there = guide_.curves().walk(on_curve_, dot(place - at_, axes_[0]));
    if (there) place = there->at;
    return there.has_value();
  }
  const double squared_step = squared_distance(place, at_);
  const auto found = nearby().nearest(place, kLeaves * kLeaves * squared_step);
  if (found.triangle == kNone || guide_.surface().patch_of(found.triangle) != patch_) return false;
  if (!(dot(area_normal(guide_.tree().corners(found.triangle)), normal_) > 0)) return false;
  place = found.point;
  return true;
}

bool SlidingVertex::keeps_truth(Vec3 place) const {
  moved_ = triangles_;
  for (TriangleCorners& t : moved_) t[0] = place;
  for (std::size_t k = 0; k < moved_.size(); ++k)
    if (!(dot(area_normal(moved_[k]), area_normal(triangles_[k])) > 0)) return false;
  const BoundaryGuide::Truth has = guide_.truth_of(moved_, &nearby());
  if (BoundaryGuide::is_true(has, near_limit())) return true;
  if (!had_) had_ = guide_.truth_of(triangles_, &nearby());
  return BoundaryGuide::keeps_truth(*had_, has, near_limit());
}

}  // namespace octafront::improve
