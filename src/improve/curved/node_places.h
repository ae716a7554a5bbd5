#pragma once

// Where the nodes inside straight edges and faces of order p lie, and where a curved one's are looked for.

#include <octafront/ids.h>
#include <octafront/vec.h>

#include "base/geometry/tet_lattice.h"
#include "base/mesh/edge_table.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numbers>
#include <span>

namespace octafront::curved {

/// A place between corners, by its barycentric coordinates times p; `at` without.
template <std::size_t kCorners>
struct NodePlace {
  std::array<double, kCorners> weights{};
  double order = 1;

  std::array<double, kCorners> at() const {
    std::array<double, kCorners> at;
    for (std::size_t i = 0; i < kCorners; ++i) at[i] = weights[i] / order;
    return at;
  }
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
  /// How far from here parabolas lead that are so far off the middles of edges (0 1), (0 2), (1 2).
  Vec3 on_parabolas(std::span<const Vec3> off) const {
    Vec3 sum;
    std::size_t edge = 0;
    for (std::size_t i = 0; i < kCorners; ++i)
      for (std::size_t j = i + 1; j < kCorners; ++j) sum += 4 * weights[i] * weights[j] / (order * order) * off[edge++];
    return sum;
  }
};

/// The nodes of a curved edge or face are looked for from places this far from the straight one towards the parabolas
/// through the middles of its edges. From the straight one they would crowd in the middle, and the polynomial miss an
/// arc of half-angle a by a^4 / 13 of its radius at order 3, by a^6 / 170 at order 4; from here by powers of a^6 and
/// a^8.
inline double part_of_parabola(int order) {
  return order == 3 ? 0.75 : std::numbers::sqrt2 / 2;
}

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

/// Of the edges (0 1), (0 2), (1 2) of a face, its corners ascending: what the edges of a table have.
inline std::array<Vec3, 3> bulges_of_face(const EdgeTable& table, std::span<const Vec3> of_edges, const Triangle& c) {
  std::array<Vec3, 3> bulges;
  for (std::size_t i = 0; i < 3; ++i) {
    const Edge edge{c[i == 2], c[i == 0 ? 1 : 2]};
    const auto found = std::ranges::lower_bound(table.edges, edge);
    bulges[i] = of_edges[static_cast<std::size_t>(found - table.edges.begin())];
  }
  return bulges;
}

}  // namespace octafront::curved
