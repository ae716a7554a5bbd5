#include "sizing/field/octree_field.h"

#include "base/core/parallel.h"

#include <algorithm>

namespace octafront {

double OctreeField::at(Vec3 p, std::size_t l) const {
  const OctreeKey key = tree.leaf(l);
  const auto corner = key.corner();
  const double scale = (1u << key.level()) / root.side, unit = 1.0 / key.side();
  const auto local = [&](int axis) {
    return std::clamp((p[axis] - root.lo[axis]) * scale - corner[axis] * unit, 0.0, 1.0);
  };
  return trilinear(h[l], local(0), local(1), local(2)) * root.side;
}

void OctreeField::find_range() {
  low = high = h.front()[0];
  for (const auto& leaf : h) {
    for (const double v : leaf) {
      low = std::min(low, v);
      high = std::max(high, v);
    }
  }
}

std::vector<std::array<double, 8>> sizes_at_leaves(const SizeField& sizes, const RootCube& root, const Octree& tree) {
  std::vector<std::array<double, 8>> h(tree.size());
  parallel_for(h.size(), [&](std::size_t l) {
    const Vec3 lo = root.corner_of(tree.leaf(l));
    const double side = root.side_of(tree.leaf(l));
    for (int k = 0; k < 8; ++k)
      h[l][k] = sizes.at(lo + side * Vec3{double(k & 1), double(k >> 1 & 1), double(k >> 2)}) / root.side;
  });
  return h;
}

const OctreeField* as_octree_field(const SizeField& sizes) {
  return dynamic_cast<const OctreeField*>(&SizeFunction::behind(sizes));
}

}  // namespace octafront
