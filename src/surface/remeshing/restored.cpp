#include "surface/remeshing/restored.h"

#include "geometry/measures.h"

#include <algorithm>

namespace octafront::remeshing {

std::vector<std::uint8_t> mark_restored(InputSurface& input, const std::vector<Ball>& balls) {
  HalfEdgeMesh& mesh = input.mesh;
  std::vector<std::uint8_t> is_fixed(mesh.points.size(), 0);
  if (balls.empty()) return is_fixed;
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    if (input.is_back(t)) continue;
    const Vec3 a = mesh.corner(t, 0), b = mesh.corner(t, 1), c = mesh.corner(t, 2);
    const bool reaches_in = std::any_of(balls.begin(), balls.end(), [&](const Ball& ball) {
      return distance(closest_point_on_triangle(ball.center, a, b, c), ball.center) < ball.radius;
    });
    if (!reaches_in) continue;
    for (HalfEdge h = 3 * t; h < 3 * t + 3; ++h) {
      mesh.set_feature(h, true);
      input.on_feature[mesh.start[h]] = is_fixed[mesh.start[h]] = 1;
    }
  }
  return is_fixed;
}

}  // namespace octafront::remeshing
