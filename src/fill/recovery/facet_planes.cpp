#include "fill/recovery/facet_planes.h"

#include <algorithm>
#include <numeric>

namespace octafront::recovery {

std::vector<std::uint32_t> facet_planes(const ExactPoints& points, const std::vector<Triangle>& triangles) {
  struct Side {
    VertexIndex a, b, opposite;
    std::uint32_t triangle;
  };
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::uint32_t f = 0; f < triangles.size(); ++f) {
    const Triangle& t = triangles[f];
    for (int i = 0; i < 3; ++i) {
      const auto [a, b] = std::minmax(t[i], t[(i + 1) % 3]);
      sides.push_back({a, b, t[(i + 2) % 3], f});
    }
  }
  std::ranges::sort(sides, {}, [](const Side& s) { return std::array{s.a, s.b, s.triangle}; });
  std::vector<std::uint32_t> plane(triangles.size());
  std::iota(plane.begin(), plane.end(), 0u);
  const auto root = [&](std::uint32_t f) {
    while (plane[f] != f) f = plane[f] = plane[plane[f]];
    return f;
  };
  for (std::size_t i = 0; i < sides.size(); ++i) {
    for (std::size_t j = i + 1; j < sides.size() && sides[j].a == sides[i].a && sides[j].b == sides[i].b; ++j) {
      if (points.orient(sides[i].a, sides[i].b, sides[i].opposite, sides[j].opposite) != 0) continue;
      plane[root(sides[j].triangle)] = root(sides[i].triangle);
    }
  }
  for (std::uint32_t f = 0; f < triangles.size(); ++f) plane[f] = root(f);
  return plane;
}

}  // namespace octafront::recovery
