#include "sizing/sources/model_extent.h"

#include <octafront/surface_mesh.h>

#include "base/geometry/measures.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace octafront {

namespace {

constexpr double kExtentPerSize = 20;

}  // namespace

double model_extent(const SurfaceMesh& surface) {
  const Vec3 origin = bounding_box(surface.points).center();
  double mass = 0, square = 0;
  Vec3 moment;
  for (const Triangle& t : surface.triangles) {
    const Vec3 a = surface.points[t[0]] - origin, b = surface.points[t[1]] - origin, c = surface.points[t[2]] - origin;
    const double area = triangle_area(a, b, c);
    const Vec3 sum = a + b + c;
    mass += area;
    moment += sum * (area / 3);
    square += area / 12 * (squared_length(a) + squared_length(b) + squared_length(c) + squared_length(sum));
  }
  if (!(mass > 0)) return 0;
  return 2 * std::sqrt(3 * std::max(0.0, square / mass - squared_length(moment / mass)));
}

double base_size(const SurfaceMesh& surface) {
  return model_extent(surface) / kExtentPerSize;
}

double slenderness(const SurfaceMesh& surface) {
  const double a = area(surface), v = enclosed_volume(surface);
  return a * a * a / (8 * std::numbers::pi * v * v);
}

}  // namespace octafront
