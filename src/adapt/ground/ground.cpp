#include "adapt/ground/ground.h"

#include "base/geometry/measures.h"

#include <algorithm>
#include <cmath>

namespace octafront::adapt {
namespace {

/// A foot is not on the other side of a thin wall, nor around a sharp edge.
constexpr double kLeastCosineOfFoot = 0.5;
/// Triangles are divided into four so many times at most.
constexpr int kMostDivisionsOfGround = 5;

}  // namespace

Ground::Ground(Walls walls)
    : walls_(std::move(walls)), tree_(walls_.surface), smooth_(walls_.surface, walls_.edges, tree_, walls_.lines) {
  std::vector<curved::Foot> on_surface(walls_.surface.triangles.size()), on_lines(walls_.lines.edges.size());
  for (std::uint32_t t = 0; t < on_surface.size(); ++t) on_surface[t].on = t;
  for (std::uint32_t e = 0; e < on_lines.size(); ++e) on_lines[e].on = e;
  smooth_.prepare(on_surface, on_lines);
  for (std::uint32_t e = 0; e < on_lines.size(); ++e) line_at_.find_or_add(walls_.lines.edges[e]) = e;
}

std::optional<curved::Foot> Ground::foot(Vec3 p, std::uint32_t part, bool outer, Vec3 normal, double reach) const {
  const double least = kLeastCosineOfFoot * length(normal);
  const auto fits = [&](std::uint32_t t, const TriangleCorners& c) {
    if (walls_.surface.patch[t] != part) return false;
    const Vec3 n = double_area_normal(c[0], c[1], c[2]);
    const double cosine = dot(n, normal);
    return (outer ? cosine : std::abs(cosine)) >= least * length(n);
  };
  const TriangleTree::Nearest nearest = tree_.nearest(p, reach * reach);
  if (nearest.triangle == kNone) return std::nullopt;
  if (fits(nearest.triangle, tree_.corners(nearest.triangle))) return curved::Foot{nearest.point, nearest.triangle};
  curved::Foot best;
  double best_distance = reach * reach;
  const Vec3 r{reach, reach, reach};
  tree_.for_each_box_near({p - r, p + r}, [&](std::uint32_t t, const TriangleCorners& c) {
    if (!fits(t, c)) return true;
    const Vec3 q = closest_point_on_triangle(p, c[0], c[1], c[2]);
    const double d = squared_distance(p, q);
    if (d < best_distance || (d == best_distance && t < best.on)) best = {q, t}, best_distance = d;
    return true;
  });
  if (best.on == kNone) return std::nullopt;
  return best;
}

std::optional<Vec3> Ground::on_surface(Vec3 p, std::uint32_t part, bool outer, Vec3 normal, double reach) const {
  const auto at = foot(p, part, outer, normal, reach);
  if (!at) return std::nullopt;
  return smooth_.surface_point(*at);
}

std::optional<Vec3> Ground::on_line(Vec3 p, std::uint32_t path, double reach) const {
  const auto at = smooth_.curve_foot(p, reach);
  if (!at || walls_.path[at->on] != path) return std::nullopt;
  return smooth_.curve_point(*at);
}

Vec3 Ground::smooth_at(std::uint32_t triangle, Vec3 weights) const {
  const auto& corners = tree_.corners(triangle);
  const auto flat = [&](Vec3 w) { return w.x * corners[0] + w.y * corners[1] + w.z * corners[2]; };
  Vec3 at = smooth_.surface_point({flat(weights), triangle});
  // Where a side lies on a line the surface goes along with it: patches end at smooth lines, not at their chords.
  const Triangle& t = walls_.surface.triangles[triangle];
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const double share = weights[j] + weights[k];
    const std::uint32_t* line =
        line_at_.find(sorted_edge(t[static_cast<std::size_t>(j)], t[static_cast<std::size_t>(k)]));
    if (!line || share <= 0) continue;
    Vec3 beside{};
    beside[j] = weights[j] / share, beside[k] = weights[k] / share;
    const Vec3 foot = flat(beside);
    at += share * share * (smooth_.curve_point({foot, *line}) - smooth_.surface_point({foot, triangle}));
  }
  return at;
}

std::vector<TriangleCorners> Ground::divided(std::uint32_t triangle, double tolerance) const {
  struct Part {
    TriangleCorners weights;  ///< barycentric, of the corners
    int depth;
  };
  std::vector<Part> stack{{{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}, 0}};
  std::vector<TriangleCorners> made;
  while (!stack.empty()) {
    const Part part = stack.back();
    stack.pop_back();
    const auto& [a, b, c] = part.weights;
    const Vec3 ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
    const TriangleCorners on{smooth_at(triangle, a), smooth_at(triangle, b), smooth_at(triangle, c)};
    const auto strays = [&](Vec3 at, Vec3 chord) { return distance(smooth_at(triangle, at), chord) > tolerance; };
    if (part.depth < kMostDivisionsOfGround &&
        (strays(ab, 0.5 * (on[0] + on[1])) || strays(bc, 0.5 * (on[1] + on[2])) || strays(ca, 0.5 * (on[2] + on[0])) ||
         strays(centroid(a, b, c), centroid(on[0], on[1], on[2])))) {
      for (const TriangleCorners& quarter : {TriangleCorners{a, ab, ca}, TriangleCorners{ab, b, bc},
                                             TriangleCorners{ca, bc, c}, TriangleCorners{ab, bc, ca}})
        stack.push_back({quarter, part.depth + 1});
    } else {
      made.push_back(on);
    }
  }
  return made;
}

Ground::Truth Ground::truth_of(const TriangleCorners& t, std::uint32_t part, bool outer, double reach) const {
  const Vec3 normal = double_area_normal(t[0], t[1], t[2]);
  Truth truth;
  const std::array<Vec3, 4> places{centroid(t[0], t[1], t[2]), 0.5 * (t[0] + t[1]), 0.5 * (t[1] + t[2]),
                                   0.5 * (t[2] + t[0])};
  for (std::size_t k = 0; k < places.size(); ++k) {
    const auto at = foot(places[k], part, outer, normal, reach);
    if (!at) return {HUGE_VAL, -1};
    truth.distance = std::max(truth.distance, distance(places[k], smooth_.surface_point(*at)));
    if (k != 0) continue;
    const auto& [a, b, c] = tree_.corners(at->on);
    const Vec3 n = double_area_normal(a, b, c);
    const double cosine = dot(n, normal) / (length(n) * length(normal) + 1e-300);
    truth.cosine = outer ? cosine : std::abs(cosine);
  }
  return truth;
}

}  // namespace octafront::adapt
