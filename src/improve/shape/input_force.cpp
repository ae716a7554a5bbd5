#include "improve/shape/input_force.h"

#include <octafront/surface_mesh.h>

#include "base/core/disjoint_sets.h"
#include "base/core/elementary.h"
#include "base/geometry/measures.h"
#include "base/mesh/complex.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace octafront::improve {

namespace {

/// Angles below 20 degrees force poor elements, and sheets nearer than a tenth of an element.
constexpr double kNarrow = 20 * std::numbers::pi / 180;
constexpr double kThin = 0.1;
/// A wedge is looked for this far from the element, in sizes, and must show at two places: less is a fold, which is
/// ours to smooth over.
constexpr double kNearWedge = 0.5, kFarWedge = 1.6;
constexpr int kPlaces = 2;
/// Steps of a walk along a feature curve: it ends sooner unless the input is far finer than the elements.
constexpr int kMostSteps = 1000;

constexpr double kThird = 0.5773502691896258;
constexpr Vec3 kDirections[] = {{1, 0, 0},
                                {-1, 0, 0},
                                {0, 1, 0},
                                {0, -1, 0},
                                {0, 0, 1},
                                {0, 0, -1},
                                {kThird, kThird, kThird},
                                {kThird, kThird, -kThird},
                                {kThird, -kThird, kThird},
                                {kThird, -kThird, -kThird},
                                {-kThird, kThird, kThird},
                                {-kThird, kThird, -kThird},
                                {-kThird, -kThird, kThird},
                                {-kThird, -kThird, -kThird}};

/// The curve of each feature edge: edges on both sides of a vertex are of one curve, unless it is a corner.
std::vector<std::uint32_t> curves_of(const Features& features, std::size_t points) {
  std::vector<std::uint32_t> last(points, kNone), curve;
  std::vector<std::uint8_t> is_corner(points, 0);
  for (const VertexIndex v : features.corners) is_corner[v] = 1;
  DisjointSets sets(features.edges.size());
  for (std::uint32_t e = 0; e < features.edges.size(); ++e)
    for (const VertexIndex v : features.edges[e]) {
      if (last[v] != kNone && is_corner[v] == 0) sets.join(last[v], e);
      last[v] = e;
    }
  for (std::uint32_t e = 0; e < features.edges.size(); ++e) curve.push_back(sets.find(e));
  return curve;
}

/// The corners that each curve ends at.
std::vector<std::array<VertexIndex, 2>> ends_of(const Features& features, const std::vector<std::uint32_t>& curve,
                                                std::size_t points) {
  std::vector<std::uint8_t> is_corner(points, 0);
  for (const VertexIndex v : features.corners) is_corner[v] = 1;
  std::vector<std::array<VertexIndex, 2>> ends(curve.size(), {kNone, kNone});
  for (std::uint32_t e = 0; e < curve.size(); ++e)
    for (const VertexIndex v : features.edges[e])
      if (is_corner[v] != 0) ends[curve[e]][ends[curve[e]][0] != kNone] = v;
  return ends;
}

}  // namespace

InputForce::InputForce(const BoundaryInput& input) : input_(input), is_complex_(is_complex(input.surface)) {
  segments_ = tree_of_segments(input.surface.points, input.features.edges);
  curve_ = curves_of(input.features, input.surface.points.size());
  ends_ = ends_of(input.features, curve_, input.surface.points.size());
  for (const Edge& e : input.features.edges) {
    lines_.push_back(e);
    lines_.push_back({e[1], e[0]});
  }
  std::sort(lines_.begin(), lines_.end());
  for (const VertexIndex v : input.features.corners) corners_.emplace_back(input.surface.points[v].x, v);
  std::sort(corners_.begin(), corners_.end());
}

InputForce::Cause InputForce::cause_at(Vec3 center, double h) const {
  if (wall_at(center, center, h).thickness < kThin * h) return Cause::kThin;
  if (has_narrow_corner(center, h)) return Cause::kCorner;
  if (is_complex_)
    if (const Cause cause = between_near_curves(center, h); cause != Cause::kNone) return cause;
  int wedge = 0, thin = 0;
  for (const Vec3 d : kDirections) {
    const Wall wall = wall_at(center + d * h, center, h);
    if (wall.distance > kFarWedge * h) continue;
    thin += wall.thickness < kThin * h && wall.distance < h;
    wedge += wall.distance > kNearWedge * h && wall.thickness < elementary::tan(kNarrow) * wall.distance;
  }
  if (wedge >= kPlaces) return Cause::kWedge;
  return thin >= kPlaces ? Cause::kThin : Cause::kNone;
}

InputForce::Cause InputForce::cause_of(const std::array<Vec3, 4>& element) const {
  const Vec3 center = centroid(element[0], element[1], element[2], element[3]);
  const double h = std::sqrt(longest_squared_edge(element[0], element[1], element[2], element[3]));
  if (const Cause cause = cause_at(center, h); cause != Cause::kNone) return cause;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j <= i; ++j)
      if (wall_at((element[i] + element[j]) / 2, center, h).thickness < kThin * h) return Cause::kThin;
  return is_complex_ ? Cause::kNone : between_near_curves(center, h);
}

/// How thick the body is at the point of the surface nearest to p, up to the sheet that faces the other way.
InputForce::Wall InputForce::wall_at(Vec3 p, Vec3 center, double h) const {
  const TriangleTree::Nearest at = input_.tree.nearest(p, kFarWedge * kFarWedge * h * h);
  if (at.triangle == kNone) return {HUGE_VAL, HUGE_VAL};
  const auto normal_of = [&](std::uint32_t t) {
    const auto& [a, b, c] = input_.tree.corners(t);
    return unit_normal(a, b, c);
  };
  // A wall of a complex has an element on either side: what counts is the one around the centre.
  const Vec3 normal = normal_of(at.triangle);
  const bool in_front = is_complex_ && dot(center - at.point, normal) > 0;
  const Vec3 inward = in_front ? normal : -normal;
  Wall wall{HUGE_VAL, distance(at.point, center)};
  const double skin = 1e-6 * h;  // the ray leaves the triangle that it starts from
  const auto is_behind = [&](const TriangleTree::RayHit& hit) {
    if (hit.triangle == kNone || hit.triangle == at.triangle) return false;
    const double facing = dot(normal_of(hit.triangle), inward);
    return (is_complex_ ? std::abs(facing) : facing) > elementary::cos(kNarrow);
  };
  const Vec3 from = at.point + inward * skin;
  if (const TriangleTree::RayHit hit = input_.tree.first_hit(from, inward, h); is_behind(hit)) wall.thickness = hit.t;
  // Where the wall is thinner than the skin its other side lies behind the start.
  if (const TriangleTree::RayHit hit = input_.tree.first_hit(from, -inward, 2 * skin); is_behind(hit))
    wall.thickness = std::max(0.0, skin - hit.t);
  return wall;
}

/// Two curves run side by side here: at less than 20 degrees, and nearer than a tenth of the element, or than 20
/// degrees let them part within it after the corner where both end.
InputForce::Cause InputForce::between_near_curves(Vec3 center, double h) const {
  struct Near {
    std::uint32_t edge;
    Vec3 at;
  };
  std::vector<Near> near;
  segments_->for_each_box_near({center - Vec3{h, h, h}, center + Vec3{h, h, h}},
                               [&](std::uint32_t edge, const TriangleCorners& c) {
                                 const Vec3 at = closest_point_on_segment(center, c[0], c[1]);
                                 if (squared_length(at - center) < h * h) near.push_back({edge, at});
                                 return true;
                               });
  for (const Near& one : near) {
    for (const Near& other : near) {
      if (curve_[one.edge] == curve_[other.edge]) continue;
      const auto &p = segments_->corners(one.edge), &q = segments_->corners(other.edge);
      const Vec3 along = normalized(p[1] - p[0]);
      if (std::abs(dot(along, normalized(q[1] - q[0]))) < elementary::cos(kNarrow)) continue;
      const Vec3 across = closest_point_on_segment(one.at, q[0], q[1]) - one.at;
      // One that goes on where the other ends is not beside it.
      const double gap = length(across);
      if (gap == 0 || std::abs(dot(across, along)) > elementary::sin(kNarrow) * gap) continue;
      if (gap < kThin * h) return Cause::kThin;
      if (gap < elementary::tan(kNarrow) * h && share_an_end(curve_[one.edge], curve_[other.edge]))
        return Cause::kCorner;
    }
  }
  return Cause::kNone;
}

bool InputForce::share_an_end(std::uint32_t curve, std::uint32_t other) const {
  const auto& ends = ends_[other];
  return std::any_of(ends_[curve].begin(), ends_[curve].end(),
                     [&](VertexIndex v) { return v != kNone && (v == ends[0] || v == ends[1]); });
}

bool InputForce::has_narrow_corner(Vec3 center, double h) const {
  std::vector<Vec3> directions;
  for (auto corner = std::lower_bound(corners_.begin(), corners_.end(), std::pair(center.x - h, VertexIndex{0}));
       corner != corners_.end() && corner->first <= center.x + h; ++corner) {
    const VertexIndex v = corner->second;
    if (distance(input_.surface.points[v], center) > h) continue;
    directions.clear();
    for (auto it = std::lower_bound(lines_.begin(), lines_.end(), Edge{v, 0}); it != lines_.end() && (*it)[0] == v;
         ++it)
      directions.push_back(direction_at_scale(v, (*it)[1], h));
    for (std::size_t i = 0; i < directions.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const double cosine = dot(directions[i], directions[j]);
        // Lines that never part at this scale are one line.
        if (cosine > elementary::cos(kNarrow) && cosine < elementary::cos(0.5 * kThin)) return true;
      }
    }
  }
  return false;
}

/// From a corner to the point that lies h away along the curve that begins with this edge, or to where it ends.
Vec3 InputForce::direction_at_scale(VertexIndex from, VertexIndex to, double h) const {
  const Vec3 start = input_.surface.points[from];
  VertexIndex before = from, at = to;
  for (int step = 0; step < kMostSteps && distance(input_.surface.points[at], start) < h; ++step) {
    const auto first = std::lower_bound(lines_.begin(), lines_.end(), Edge{at, 0});
    const auto last = std::lower_bound(first, lines_.end(), Edge{at + 1, 0});
    if (last - first != 2) break;
    const VertexIndex next = (*first)[1] == before ? first[1][1] : (*first)[1];
    before = at;
    at = next;
  }
  return normalized(input_.surface.points[at] - start);
}

}  // namespace octafront::improve
