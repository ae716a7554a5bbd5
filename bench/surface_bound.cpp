#include "surface_bound.h"

#include <octafront/quality.h>

#include "geometry/measures.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

namespace {

using namespace octafront;

// The triangles that are likely to bound beta: the worst by themselves.
constexpr std::size_t kExamined = 50;
constexpr double kSmallestStep = 1e-6;

// The best beta of a tetrahedron on the triangle: a compass search over the place of its apex, from above the centroid
// and from above the middle of the shortest side, where the best elements on needles have theirs.
double best_on(Vec3 a, Vec3 b, Vec3 c) {
  if (distance(b, c) < distance(a, b)) std::swap(a, c);
  if (distance(c, a) < distance(a, b)) std::swap(b, c);
  const Vec3 u = normalized(b - a), n = unit_normal(a, b, c), v = cross(n, u);
  const double shortest = distance(a, b), longest = std::max(distance(b, c), distance(c, a));
  double best = 0;
  for (const Vec3 start : {centroid(a, b, c) + n * (0.8 * longest), (a + b) / 2 + n * (0.8 * shortest)}) {
    Vec3 at = start;
    double value = std::abs(radius_ratio(a, b, c, at));
    for (double step = 0.3 * longest; step > kSmallestStep * shortest;) {
      bool better = false;
      for (const Vec3 d : {u, -u, v, -v, n, -n}) {
        const double q = std::abs(radius_ratio(a, b, c, at + d * step));
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

}  // namespace

SurfaceBound bound_of(const SurfaceMesh& surface) {
  SurfaceBound bound;
  const auto& p = surface.points;
  std::vector<std::pair<double, const Triangle*>> worst;
  std::map<Edge, VertexIndex> apex;
  for (const Triangle& t : surface.triangles) {
    worst.emplace_back(radius_ratio(p[t[0]], p[t[1]], p[t[2]]), &t);
    for (int i = 0; i < 3; ++i) {
      const VertexIndex a = t[i], b = t[(i + 1) % 3], c = t[(i + 2) % 3];
      apex[{a, b}] = c;
      if (const auto other = apex.find({b, a}); other != apex.end())
        bound.dihedral = std::min(bound.dihedral, angle_inside(p[a], p[b], p[c], p[other->second]));
    }
  }
  const std::size_t examined = std::min(kExamined, worst.size());
  std::partial_sort(worst.begin(), worst.begin() + static_cast<std::ptrdiff_t>(examined), worst.end());
  for (std::size_t i = 0; i < examined; ++i) {
    const auto& [a, b, c] = *worst[i].second;
    bound.beta = std::min(bound.beta, best_on(p[a], p[b], p[c]));
  }
  return bound;
}
