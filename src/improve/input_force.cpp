#include "improve/input_force.h"

#include "geometry/measures.h"

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
constexpr double kNear = 0.5, kFar = 1.6;
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

}  // namespace

InputForce::InputForce(const BoundaryInput& input) : input_(input) {
  for (const Edge& e : input.features.edges) {
    lines_.push_back(e);
    lines_.push_back({e[1], e[0]});
  }
  std::sort(lines_.begin(), lines_.end());
}

InputForce::Cause InputForce::cause_at(Vec3 center, double h) const {
  if (wall_at(center, center, h).thickness < kThin * h) return Cause::kThin;
  if (has_narrow_corner(center, h)) return Cause::kCorner;
  int wedge = 0, thin = 0;
  for (const Vec3 d : kDirections) {
    const Wall wall = wall_at(center + d * h, center, h);
    if (wall.distance > kFar * h) continue;
    thin += wall.thickness < kThin * h && wall.distance < h;
    wedge += wall.distance > kNear * h && wall.thickness < std::tan(kNarrow) * wall.distance;
  }
  if (wedge >= kPlaces) return Cause::kWedge;
  return thin >= kPlaces ? Cause::kThin : Cause::kNone;
}

/// How thick the body is at the point of the surface nearest to p, up to the sheet that faces the other way.
InputForce::Wall InputForce::wall_at(Vec3 p, Vec3 center, double h) const {
  const TriangleTree::Nearest at = input_.tree.nearest(p, kFar * kFar * h * h);
  if (at.triangle == kNone) return {HUGE_VAL, HUGE_VAL};
  const auto normal_of = [&](std::uint32_t t) {
    const auto& [a, b, c] = input_.tree.corners(t);
    return unit_normal(a, b, c);
  };
  const Vec3 inward = -normal_of(at.triangle);
  Wall wall{HUGE_VAL, distance(at.point, center)};
  constexpr double kSkin = 1e-6;  // of h: the ray leaves the triangle that it starts from
  const TriangleTree::RayHit hit = input_.tree.first_hit(at.point + inward * (kSkin * h), inward, h);
  if (hit.triangle != kNone && hit.triangle != at.triangle && dot(normal_of(hit.triangle), inward) > std::cos(kNarrow))
    wall.thickness = hit.t;
  return wall;
}

bool InputForce::has_narrow_corner(Vec3 center, double h) const {
  for (const VertexIndex v : input_.features.corners) {
    if (distance(input_.surface.points[v], center) > h) continue;
    std::vector<Vec3> directions;
    for (auto it = std::lower_bound(lines_.begin(), lines_.end(), Edge{v, 0}); it != lines_.end() && (*it)[0] == v;
         ++it)
      directions.push_back(direction_at_scale(v, (*it)[1], h));
    for (std::size_t i = 0; i < directions.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const double cosine = dot(directions[i], directions[j]);
        // Lines that never part at this scale are one line.
        if (cosine > std::cos(kNarrow) && cosine < std::cos(0.5 * kThin)) return true;
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
