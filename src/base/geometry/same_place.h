#pragma once

#include <octafront/ids.h>
#include <octafront/vec.h>

#include "base/core/parallel.h"

#include <array>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace octafront {

/// Per point the first one at the same place (0 equals -0): files such as STL say each corner of each triangle.
inline std::vector<VertexIndex> first_at_place(std::span<const Vec3> points) {
  std::vector<VertexIndex> order(points.size()), first(points.size());
  std::iota(order.begin(), order.end(), VertexIndex{0});
  const auto key = [&](VertexIndex v) { return std::pair(std::array{points[v].x, points[v].y, points[v].z}, v); };
  parallel_sort(order, [&](VertexIndex a, VertexIndex b) { return key(a) < key(b); });
  for (std::size_t i = 0; i < order.size(); ++i)
    first[order[i]] = i > 0 && points[order[i]] == points[order[i - 1]] ? first[order[i - 1]] : order[i];
  return first;
}

}  // namespace octafront
