#include <octafront/surface_mesh.h>

#include "base/core/parallel_arrays.h"
#include "base/core/random.h"

#include <bit>

namespace octafront {

Box3 bounding_box(const std::vector<Vec3>& points) {
  struct Part {
    Box3 box;
    Part& operator+=(const Part& other) { return box.add(other.box), *this; }
  };
  return parallel_sum(points.size(),
                      [&](std::size_t begin, std::size_t end) {
                        Part part;
                        for (std::size_t i = begin; i < end; ++i) part.box.add(points[i]);
                        return part;
                      })
      .box;
}

double enclosed_volume(const SurfaceMesh& surface) {
  if (surface.points.empty()) return 0;
  // Measured from the middle, so that a model far from the origin loses no digits.
  const Vec3 o = bounding_box(surface.points).center();
  return sum_in_order(surface.triangles.size(),
                      [&](std::size_t i) {
                        const auto [front, behind] = surface.sides_of(i);
                        if ((front == kNone) == (behind == kNone)) return 0.0;  // between regions
                        const Triangle& t = surface.triangles[i];
                        const double term =
                            dot(surface.points[t[0]] - o, cross(surface.points[t[1]] - o, surface.points[t[2]] - o));
                        return front == kNone ? term : -term;
                      }) /
         6;
}

double area(const SurfaceMesh& surface) {
  return sum_in_order(
             surface.triangles.size(),
             [&](std::size_t i) {
               const auto& [a, b, c] = surface.triangles[i];
               return length(cross(surface.points[b] - surface.points[a], surface.points[c] - surface.points[a]));
             }) /
         2;
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
