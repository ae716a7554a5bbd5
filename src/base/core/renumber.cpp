#include "base/core/renumber.h"

#include <algorithm>

namespace octafront {

void drop_unused_points(std::vector<Vec3>& points, std::vector<Triangle>& triangles, std::size_t kept) {
  std::vector<VertexIndex> number(points.size(), kNone);
  std::fill_n(number.begin(), kept, 0);
  mark_used(triangles, number);
  keep_numbered(points, number);
  renumber(triangles, number);
}

}  // namespace octafront
