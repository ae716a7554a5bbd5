#include "surface_bound.h"

#include <octafront/quality.h>

#include "base/geometry/measures.h"
#include "base/geometry/triangle_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

namespace {

using namespace octafront;

// The triangles that are likely to bound beta: the worst by themselves.
constexpr std::size_t kExamined = 50;
constexpr double kSmallestStep = 1e-6;
constexpr double kEnoughSteps = 3000;

// The best beta of an element on a triangle: a compass search over the place of its apex, from above the centroid and
// from above the middle of the shortest side, where the best elements on needles have theirs. The triangle faces
// outward, apexes lie against its normal, and where `sees(apex)` does not hold there are none.
template <class Sees>
double best_on(Vec3 a, Vec3 b, Vec3 c, Sees&& sees) {
  if (distance(b, c) < distance(a, b)) std::tie(a, b, c) = std::tuple(b, c, a);
  if (distance(c, a) < distance(a, b)) std::tie(a, b, c) = std::tuple(c, a, b);
  const Vec3 u = normalized(b - a), n = -unit_normal(a, b, c), v = cross(n, u);
  const double shortest = distance(a, b), longest = std::max(distance(b, c), distance(c, a));
  const auto value_at = [&](Vec3 p) {
    return dot(p - a, n) > 0 && sees(p) ? std::abs(radius_ratio(a, b, c, p)) : -1.0;
  };
  double best = 0;
  for (const auto& [foot, height] :
       {std::pair{centroid(a, b, c), 0.8 * longest}, {(a + b) / 2 + 0.1 * (c - a), 0.8 * shortest}}) {
    Vec3 at = foot + n * height;
    for (int halvings = 0; halvings < 30 && value_at(at) < 0; ++halvings) at = (at + foot) / 2;
    double value = value_at(at);
    int steps = 0;
    for (double step = 0.3 * longest; step > kSmallestStep * shortest && steps < kEnoughSteps;) {
      bool better = false;
      for (const Vec3 d : {u, -u, v, -v, n, -n}) {
        ++steps;
        const double q = value_at(at + d * step);
        if (q <= value) continue;
        value = q;
        at += d * step;
        better = true;
      }
      if (!better) step /= 2;
    }
    best = std::max(best, value);
  }
  return best;
}

// The angle inside between two triangles with the edge (a, b), the first of which has it in this direction and the apex
// c, the other the apex d.
double angle_inside(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const Vec3 axis = normalized(b - a), first = unit_normal(a, b, c), second = unit_normal(b, a, d);
  const double turn = std::atan2(dot(cross(first, second), axis), dot(first, second));
  return 180 - turn * 180 / std::numbers::pi;
}

// Calls visit(edge, degrees) for every edge of the surface.
template <class Visit>
void for_each_angle(const std::vector<Vec3>& p, const std::vector<Triangle>& triangles, Visit&& visit) {
  std::map<Edge, VertexIndex> apex;
  for (const Triangle& t : triangles) {
    for (int i = 0; i < 3; ++i) {
      const VertexIndex a = t[i], b = t[(i + 1) % 3], c = t[(i + 2) % 3];
      apex[{a, b}] = c;
      if (const auto other = apex.find({b, a}); other != apex.end())
        visit(Edge{std::min(a, b), std::max(a, b)}, angle_inside(p[a], p[b], p[c], p[other->second]));
    }
  }
}

// What inside of a surface can be seen from its triangles.
class Views {
 public:
  Views(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles)
      : points_(points), triangles_(triangles), tree_(points, triangles) {}

  double best_element_on(std::uint32_t t) const {
    const auto& [a, b, c] = triangles_[t];
    return best_on(points_[a], points_[b], points_[c], [&](Vec3 apex) { return sees(t, apex); });
  }

 private:
  // From the middle of the triangle and from near its corners; the apex itself may lie on the surface.
  bool sees(std::uint32_t t, Vec3 apex) const {
    const auto& [a, b, c] = triangles_[t];
    const Vec3 middle = centroid(points_[a], points_[b], points_[c]);
    for (const Vec3 p :
         {middle, points_[a] * 0.9 + middle * 0.1, points_[b] * 0.9 + middle * 0.1, points_[c] * 0.9 + middle * 0.1}) {
      bool hidden = false;
      tree_.for_each_hit(p + (apex - p) * 1e-3, p + (apex - p) * 0.999,
                         [&](std::uint32_t other, const SegmentHit&) { hidden |= other != t; });
      if (hidden) return false;
    }
    return true;
  }

  const std::vector<Vec3>& points_;
  const std::vector<Triangle>& triangles_;
  TriangleTree tree_;
};

double beta_of(const TetMesh& mesh, const Tet& t) {
  return radius_ratio(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]);
}

// What holds elements below a beta.
struct Culprits {
  std::set<Triangle> triangles;  ///< corners ascending
  std::set<Edge> edges;
};

// Only triangles that carry a poor element may be culprits.
Culprits culprits_of(const TetMesh& mesh, const std::vector<Tet>& poor, double beta) {
  std::map<Triangle, std::uint32_t> index;
  for (std::uint32_t t = 0; t < mesh.boundary.size(); ++t) {
    Triangle key = mesh.boundary[t];
    std::ranges::sort(key);
    index[key] = t;
  }
  const Views views(mesh.points, mesh.boundary);
  Culprits culprits;
  for (const Tet& t : poor) {
    for (const auto& f : kTetFaces) {
      Triangle key{t[f[0]], t[f[1]], t[f[2]]};
      std::ranges::sort(key);
      const auto found = index.find(key);
      if (found != index.end() && views.best_element_on(found->second) < beta) culprits.triangles.insert(key);
    }
  }
  for (const auto& [a, b, c] : culprits.triangles) culprits.edges.insert({{a, b}, {b, c}, {a, c}});
  // Of the elements with a dihedral angle x the best have beta of about sqrt(2 (1 - cos x)), or x.
  for_each_angle(mesh.points, mesh.boundary, [&](Edge edge, double degrees) {
    if (degrees * std::numbers::pi / 180 < beta) culprits.edges.insert(edge);
  });
  return culprits;
}

}  // namespace

SurfaceBound bound_of(const SurfaceMesh& surface) {
  SurfaceBound bound;
  const auto& p = surface.points;
  for_each_angle(p, surface.triangles,
                 [&](Edge, double degrees) { bound.dihedral = std::min(bound.dihedral, degrees); });
  std::vector<std::pair<double, std::uint32_t>> worst;
  for (std::uint32_t i = 0; i < surface.triangles.size(); ++i) {
    const Triangle& t = surface.triangles[i];
    worst.emplace_back(radius_ratio(p[t[0]], p[t[1]], p[t[2]]), i);
  }
  const std::size_t examined = std::min(kExamined, worst.size());
  std::partial_sort(worst.begin(), worst.begin() + static_cast<std::ptrdiff_t>(examined), worst.end());
  const Views views(p, surface.triangles);
  for (std::size_t i = 0; i < examined; ++i) bound.beta = std::min(bound.beta, views.best_element_on(worst[i].second));
  return bound;
}

PoorElements poor_elements(const TetMesh& mesh, double beta) {
  PoorElements result;
  std::vector<Tet> poor;
  std::ranges::copy_if(mesh.tets, std::back_inserter(poor), [&](const Tet& t) { return beta_of(mesh, t) < beta; });
  result.all = poor.size();
  const Culprits culprits = culprits_of(mesh, poor, beta);
  for (const Tet& t : poor) {
    const auto is_culprit = [&](const auto& f) {
      Triangle key{t[f[0]], t[f[1]], t[f[2]]};
      std::ranges::sort(key);
      return culprits.triangles.contains(key);
    };
    const auto has_culprit = [&](const auto& e) {
      return culprits.edges.contains({std::min(t[e[0]], t[e[1]]), std::max(t[e[0]], t[e[1]])});
    };
    if (std::ranges::any_of(kTetFaces, is_culprit)) {
      ++result.forced;
    } else if (std::ranges::any_of(kTetEdges, has_culprit)) {
      ++result.beside;
    } else {
      result.worst_other = std::min(result.worst_other, beta_of(mesh, t));
    }
  }
  return result;
}
