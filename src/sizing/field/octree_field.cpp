#include "sizing/field/octree_field.h"

#include "base/core/parallel.h"

#include <algorithm>
#include <cmath>

namespace octafront {

namespace {

struct SizeRange {
  double low = HUGE_VAL, high = -HUGE_VAL;

  SizeRange& operator+=(const SizeRange& other) {
    low = std::min(low, other.low), high = std::max(high, other.high);
    return *this;
  }
};

}  // namespace

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
  const auto range = parallel_sum(h.size(), [this](std::size_t begin, std::size_t end) {
    SizeRange part;
    for (std::size_t l = begin; l < end; ++l)
      for (const double v : h[l]) part += {v, v};
    return part;
  });
  low = range.low, high = range.high;
}

RawVector<std::array<double, 8>> sizes_at_leaves(const SizeField& sizes, const RootCube& root, const Octree& tree) {
  RawVector<std::array<double, 8>> h(tree.size());
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
