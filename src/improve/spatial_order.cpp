#include "improve/spatial_order.h"

#include <algorithm>

namespace octafront::improve {
namespace {

/// The lowest 21 bits of x, two zeros after each.
std::uint64_t spread(std::uint64_t x) {
  x &= 0x1fffff;
  x = (x | x << 32) & 0x1f00000000ffff;
  x = (x | x << 16) & 0x1f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  x = (x | x << 2) & 0x1249249249249249;
  return x;
}

}  // namespace

std::vector<VertexIndex> spatial_order(const std::vector<Vec3>& points) {
  Box3 box;
  for (const Vec3& p : points) box.add(p);
  const Vec3 extent = box.empty() ? Vec3{} : box.extent();
  const double side = std::max({extent.x, extent.y, extent.z});
  const double scale = side > 0 ? 2097151 / side : 0;
  struct Key {
    std::uint64_t code;
    VertexIndex vertex;
    bool operator<(const Key& o) const { return code != o.code ? code < o.code : vertex < o.vertex; }
  };
  std::vector<Key> keys(points.size());
  for (VertexIndex v = 0; v < points.size(); ++v) {
    const Vec3 p = (points[v] - box.lo) * scale;
    keys[v] = {spread(static_cast<std::uint64_t>(p.x)) << 2 | spread(static_cast<std::uint64_t>(p.y)) << 1 |
                   spread(static_cast<std::uint64_t>(p.z)),
               v};
  }
  std::sort(keys.begin(), keys.end());
  std::vector<VertexIndex> order(points.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = keys[k].vertex;
  return order;
}

std::vector<TetIndex> order_by_least_corner(const std::vector<Tet>& tets, std::size_t vertices) {
  std::vector<std::uint32_t> end(vertices + 1, 0);
  for (const Tet& t : tets) ++end[std::min({t[0], t[1], t[2], t[3]}) + 1];
  for (std::size_t v = 0; v < vertices; ++v) end[v + 1] += end[v];
  std::vector<TetIndex> order(tets.size());
  for (TetIndex t = 0; t < tets.size(); ++t)
    order[end[std::min({tets[t][0], tets[t][1], tets[t][2], tets[t][3]})]++] = t;
  return order;
}

}  // namespace octafront::improve
