#include "base/core/parallel.h"
#include "report/picture/raster.h"

#include <algorithm>
#include <cmath>

namespace octafront {

namespace {

/// Of projections on the axes of a camera.
struct Extent {
  Box3 box;
  Extent& operator+=(const Extent& b) {
    if (!b.box.empty()) box.add(b.box.lo), box.add(b.box.hi);
    return *this;
  }
};

}  // namespace

Camera looking_from(Vec3 view, Vec3 up) {
  constexpr double kAlong = 0.99;
  Camera camera;
  camera.back = normalized(view);
  for (const Vec3 other : {Vec3{0, 0, 1}, Vec3{0, 1, 0}})
    if (std::abs(dot(camera.back, normalized(up))) > kAlong) up = other;
  camera.right = normalized(cross(up, camera.back));
  camera.up = cross(camera.back, camera.right);
  return camera;
}

void fit(Camera& camera, const Scene& scene, const Rectangle& window) {
  const Extent seen = parallel_sum(scene.triangles.size(), [&](std::size_t begin, std::size_t end) {
    Extent part;
    for (std::size_t t = begin; t < end; ++t)
      for (const Vec3 p : scene.triangles[t].at)
        part.box.add(Vec3{dot(p, camera.right), dot(p, camera.up), dot(p, camera.back)});
    return part;
  });
  camera.window = window;
  if (seen.box.empty()) return;
  const Vec3 middle = 0.5 * (seen.box.lo + seen.box.hi), size = seen.box.hi - seen.box.lo;
  camera.target = middle.x * camera.right + middle.y * camera.up + middle.z * camera.back;
  const double across = size.x > 0 ? window.width() / size.x : HUGE_VAL;
  const double down = size.y > 0 ? window.height() / size.y : HUGE_VAL;
  camera.scale = std::min(across, down);
  if (!std::isfinite(camera.scale)) camera.scale = 1;
}

void fit(Camera& camera, Vec3 middle, double radius, double part, const Rectangle& window) {
  camera.window = window;
  camera.target = middle;
  if (radius > 0) camera.scale = part * std::min(window.width(), window.height()) / (2 * radius);
}

}  // namespace octafront
