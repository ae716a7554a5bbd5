#include "surface/edits/kept_places.h"

#include "base/geometry/measures.h"

namespace octafront::surface {

std::vector<std::uint8_t> mark_kept_places(InputSurface& input, const TriangleTree& tree,
                                           const std::vector<KeptPlace>& balls) {
  HalfEdgeMesh& mesh = input.mesh;
  std::vector<std::uint8_t> is_fixed(mesh.points.size(), 0);
  for (const KeptPlace& ball : balls) {
    const Vec3 r{ball.radius, ball.radius, ball.radius};
    tree.for_each_box_near({ball.center - r, ball.center + r}, [&](std::uint32_t t, const TriangleCorners& c) {
      if (distance(closest_point_on_triangle(ball.center, c[0], c[1], c[2]), ball.center) >= ball.radius) return true;
      for (HalfEdge h = 3 * t; h < 3 * t + 3; ++h) {
        mesh.set_feature(h, true);
        input.on_feature[mesh.start[h]] = is_fixed[mesh.start[h]] = 1;
      }
      return true;
    });
  }
  return is_fixed;
}

}  // namespace octafront::surface
