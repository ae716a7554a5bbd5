#include "base/geometry/spatial_order.h"

#include "base/core/morton.h"
#include "base/core/parallel.h"

#include <algorithm>

namespace octafront {

std::uint64_t curve_code(Vec3 point, const Cube& cube) {
  const Vec3 p = (point - cube.lo) * (cube.side > 0 ? 2097151 / cube.side : 0);
  const auto cell = [](double c) { return static_cast<std::uint64_t>(c); };
  return morton_code(cell(p.z), cell(p.y), cell(p.x));
}

std::vector<VertexIndex> spatial_order(const std::vector<Vec3>& points) {
  Box3 box;
  for (const Vec3& p : points) box.add(p);
  const Vec3 extent = box.empty() ? Vec3{} : box.extent();
  const Cube cube{box.lo, std::max({extent.x, extent.y, extent.z})};
  struct Key {
    std::uint64_t code;
    VertexIndex vertex;
    bool operator<(const Key& o) const { return code != o.code ? code < o.code : vertex < o.vertex; }
  };
  std::vector<Key> keys(points.size());
  parallel_for(points.size(), [&](std::size_t v) {
    keys[v] = {curve_code(points[v], cube), static_cast<VertexIndex>(v)};
  });
  parallel_sort(keys);
  std::vector<VertexIndex> order(points.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = keys[k].vertex;
  return order;
}

}  // namespace octafront
