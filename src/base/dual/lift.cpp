#include "base/dual/lift.h"

#include "base/geometry/measures.h"

#include <cmath>

namespace octafront::dual {
namespace {

/// The mean of the three tangent planes is twice as far from the chord as a sphere is.
constexpr double kOfTangentPlanes = 0.5;
/// A part of the face's size. Surfaces that a mesh resolves ask for half of it; more is noise, and would turn cells.
constexpr double kMostLift = 0.1;

Vec3 double_area_normal_of(const Primal& primal, HalfFace h) {
  const auto& [a, b, c] = corners_of(primal.mesh.tets, h);
  const std::vector<Vec3>& p = primal.mesh.points;
  return double_area_normal(p[a], p[b], p[c]);
}

/// Of the smooth part of the surface at a corner of a wall.
Vec3 normal_at(const Primal& primal, const DualPoints& points, HalfFace wall, VertexIndex v) {
  Vec3 sum = double_area_normal_of(primal, wall);
  const Triangle first = corners_of(primal.mesh.tets, wall);
  for (VertexIndex w : first) {
    if (w == v) continue;
    HalfFace h = wall;
    while (points.middle(v, w) != Middle::kCorner) {
      h = primal.end_across(h, v, w, [&](HalfFace end) { return primal.is_wall(end); });
      if (h == wall) return normalized(sum);
      sum += double_area_normal_of(primal, h);
      w = third(corners_of(primal.mesh.tets, h), v, w);
    }
  }
  return normalized(sum);
}

}  // namespace

Vec3 lift(const Primal& primal, const DualPoints& points, HalfFace wall) {
  const std::vector<Vec3>& p = primal.mesh.points;
  const Triangle face = corners_of(primal.mesh.tets, wall);
  const Vec3 middle = centroid(p[face[0]], p[face[1]], p[face[2]]);
  Vec3 sum;
  for (const VertexIndex v : face) {
    const Vec3 n = normal_at(primal, points, wall, v);
    sum -= n * dot(middle - p[v], n);
  }
  sum *= kOfTangentPlanes / 3;
  const double most = kMostLift * std::sqrt(length(double_area_normal_of(primal, wall))), asked = length(sum);
  return asked > most ? sum * (most / asked) : sum;
}

}  // namespace octafront::dual
