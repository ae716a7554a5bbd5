#pragma once

// Coordinates as keys: what lies at the same place, bit for bit but for the sign of 0.

#include <octafront/ids.h>
#include <octafront/vec.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>

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

}  // namespace octafront
