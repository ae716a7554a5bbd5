#pragma once

// What lies at the same place: coordinates bit for bit, but for the sign of 0.

#include <octafront/ids.h>
#include <octafront/vec.h>

#include "base/core/parallel.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace octafront {

using PlaceKey = std::array<double, 3>;

constexpr PlaceKey key_of(Vec3 p) {
  return {p.x, p.y, p.z};
}

/// The places of points that make up one thing (edge, triangle), in an order of their own.
template <std::size_t N>
std::array<PlaceKey, N> keys_of(const std::array<Vec3, N>& points) {
  std::array<PlaceKey, N> keys{};
  for (std::size_t i = 0; i < N; ++i) keys[i] = key_of(points[i]);
  std::ranges::sort(keys);
  return keys;
}

class VerticesByPlace {
 public:
  /// The vertex there: this one if it is the first.
  VertexIndex add(Vec3 p, VertexIndex v) { return at_.try_emplace(key_of(p), v).first->second; }
  /// kNone: none.
  VertexIndex find(Vec3 p) const {
    const auto it = at_.find(key_of(p));
    return it == at_.end() ? kNone : it->second;
  }

 private:
  std::map<PlaceKey, VertexIndex> at_;
};

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
