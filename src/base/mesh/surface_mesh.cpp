#include <octafront/surface_mesh.h>

#include "base/core/random.h"

#include <bit>

namespace octafront {

Box3 bounding_box(const std::vector<Vec3>& points) {
  Box3 box;
  for (const Vec3& p : points) box.add(p);
  return box;
}

double enclosed_volume(const SurfaceMesh& surface) {
  if (surface.points.empty()) return 0;
  // Measured from the middle, so that a model far from the origin loses no digits.
  const Vec3 o = bounding_box(surface.points).center();
  double six_volume = 0;
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    const auto [front, behind] = surface.sides_of(i);
    if ((front == kNone) == (behind == kNone)) continue;  // between regions
    const Triangle& t = surface.triangles[i];
    const double term = dot(surface.points[t[0]] - o, cross(surface.points[t[1]] - o, surface.points[t[2]] - o));
    six_volume += front == kNone ? term : -term;
  }
  return six_volume / 6;
}

double area(const SurfaceMesh& surface) {
  double twice = 0;
  for (const Triangle& t : surface.triangles)
    twice += length(cross(surface.points[t[1]] - surface.points[t[0]], surface.points[t[2]] - surface.points[t[0]]));
  return twice / 2;
}

std::uint64_t fingerprint(const SurfaceMesh& surface) {
  std::uint64_t print = mixed_bits(surface.points.size()) + surface.triangles.size();
  const auto add = [&](std::uint64_t bits) { print = mixed_bits(print ^ bits); };
  for (const Vec3& p : surface.points)
    for (const double x : {p.x, p.y, p.z}) add(std::bit_cast<std::uint64_t>(x));
  for (const auto& [a, b, c] : surface.triangles) {
    add(std::uint64_t{a} << 32 | b);
    add(c);
  }
  for (const auto& [front, behind] : surface.sides) add(std::uint64_t{front} << 32 | behind);
  return print;
}

}  // namespace octafront
