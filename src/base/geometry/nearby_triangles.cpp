#include "base/geometry/nearby_triangles.h"

#include "base/geometry/measures.h"

#include <cmath>

namespace octafront {
namespace {

// Distance from an interval, without branches: the vector units take it.
inline double outside(double from_middle, double half) {
  const double beyond = std::abs(from_middle) - half;
  return 0.5 * (beyond + std::abs(beyond));
}

}  // namespace

void NearbyTriangles::gather(const TriangleTree& tree, Vec3 center, double reach) {
  tree_ = &tree;
  const Vec3 corner{reach, reach, reach};
  reached_ = {center - corner, center + corner};
  size_ = 0;
  complete_ = tree.for_each_box_near(reached_, [&](std::uint32_t triangle, const TriangleCorners& corners) {
    if (size_ == kMost) return false;
    const Box3 box = box_of(corners);
    for (int axis = 0; axis < 3; ++axis) {
      middle_[axis][size_] = 0.5 * (box.lo[axis] + box.hi[axis]);
      half_[axis][size_] = 0.5 * (box.hi[axis] - box.lo[axis]);
    }
    corners_[size_] = &corners;
    triangle_[size_++] = triangle;
    return true;
  });
}

bool NearbyTriangles::covers(Vec3 p, double limit_squared) const {
  const double limit = std::sqrt(limit_squared);
  const Vec3 corner{limit, limit, limit};
  return complete_ && reached_.contains(p - corner) && reached_.contains(p + corner);
}

TriangleTree::Nearest NearbyTriangles::nearest(Vec3 p, double limit_squared) const {
  if (!covers(p, limit_squared)) return tree_->nearest(p, limit_squared);
  for (int i = 0; i < size_; ++i) {
    const double x = outside(p.x - middle_[0][i], half_[0][i]), y = outside(p.y - middle_[1][i], half_[1][i]),
                 z = outside(p.z - middle_[2][i], half_[2][i]);
    squared_distance_[i] = x * x + y * y + z * z;
  }
  TriangleTree::Nearest best;
  best.squared_distance = limit_squared;
  for (int i = 0; i < size_; ++i) {
    if (!(squared_distance_[i] < best.squared_distance)) continue;
    const auto& [a, b, c] = *corners_[i];
    const Vec3 q = closest_point_on_triangle(p, a, b, c);
    const double d = squared_distance(p, q);
    if (d < best.squared_distance) best = {q, triangle_[i], d};
  }
  return best;
}

}  // namespace octafront
