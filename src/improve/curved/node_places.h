#pragma once

// Where the nodes inside straight edges and faces of order p lie.

#include <octafront/ids.h>
#include <octafront/vec.h>

#include "base/geometry/tet_lattice.h"

#include <array>
#include <cstddef>
#include <span>

namespace octafront::curved {

/// A place between corners, by its barycentric coordinates times p.
template <std::size_t kCorners>
struct NodePlace {
  std::array<double, kCorners> weights{};
  double order = 1;

  Vec3 mean_of(std::span<const Vec3> corners) const {
    Vec3 sum = weights[0] * corners[0];
    for (std::size_t i = 1; i < kCorners; ++i) sum += weights[i] * corners[i];
    return sum / order;
  }
  Vec3 mean(std::span<const Vec3> points, const std::array<VertexIndex, kCorners>& corners) const {
    std::array<Vec3, kCorners> at;
    for (std::size_t i = 0; i < kCorners; ++i) at[i] = points[corners[i]];
    return mean_of(at);
  }
};

/// Node k inside an edge, from its first corner on.
inline NodePlace<2> in_edge(int order, std::size_t k) {
  const double second = static_cast<double>(k) + 1;
  return {{order - second, second}, static_cast<double>(order)};
}

/// Node k inside a face: the one nearest to its first corner first. Of orders 3 and 4.
inline NodePlace<3> in_face(int order, std::size_t k) {
  NodePlace<3> place{{1, 1, 1}, static_cast<double>(order)};
  place.weights[k] += order - 3;
  return place;
}

}  // namespace octafront::curved
