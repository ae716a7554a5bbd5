#include "lattice/near_leaves.h"

#include "core/parallel.h"
#include "lattice/graded_bcc.h"

#include <algorithm>
#include <atomic>

namespace octafront {

namespace {

class Marker {
 public:
  Marker(const LatticeOctree& lattice, std::vector<std::uint8_t>& near) : lattice_(lattice), near_(near) {}

  void mark(Box3 box, double reach) const {
    const Vec3 margin{reach, reach, reach};
    box = {box.lo - margin, box.hi + margin};
    const Vec3 extent = box.extent();
    const double largest = std::max({extent.x, extent.y, extent.z});
    int level = 0;
    while (level < kFinestLatticeLevel && lattice_.root.side / (2u << level) >= largest) ++level;
    // At most eight cells of this level meet the box.
    const auto lo = lattice_.root.cell(box.lo).ancestor(level), hi = lattice_.root.cell(box.hi).ancestor(level);
    const auto a = lo.corner(), b = hi.corner();
    const std::uint32_t side = lo.side();
    for (std::uint32_t z = a[2]; z <= b[2]; z += side)
      for (std::uint32_t y = a[1]; y <= b[1]; y += side)
        for (std::uint32_t x = a[0]; x <= b[0]; x += side) mark(OctreeKey::containing(x, y, z, level), box);
  }

 private:
  void mark(OctreeKey cell, const Box3& box) const {
    const Vec3 lo = lattice_.root.corner_of(cell);
    const double side = lattice_.root.side_of(cell);
    if (!box.overlaps({lo, lo + Vec3{side, side, side}})) return;
    const std::size_t i = lattice_.tree.find(cell);
    if (lattice_.tree.leaf(i).level() <= cell.level()) {
      std::atomic_ref(near_[i]).store(1, std::memory_order_relaxed);
      return;
    }
    for (int c = 0; c < 8; ++c) mark(cell.child(c), box);
  }

  const LatticeOctree& lattice_;
  std::vector<std::uint8_t>& near_;
};

}  // namespace

std::vector<std::uint8_t> near_leaves(const LatticeOctree& lattice, const SurfaceMesh& surface, const SizeField& sizes,
                                      double clearance) {
  std::vector<float> size(surface.points.size());
  parallel_for(size.size(), [&](std::size_t v) { size[v] = static_cast<float>(sizes.at(surface.points[v])); });
  std::vector<std::uint8_t> near(lattice.tree.size(), 0);
  const Marker marker(lattice, near);
  parallel_for(surface.triangles.size(), [&](std::size_t t) {
    Box3 box;
    double reach = 0;
    for (const VertexIndex v : surface.triangles[t]) {
      box.add(surface.points[v]);
      reach = std::max(reach, static_cast<double>(size[v]));
    }
    // Sizes grow by a part of the distance; within the clearance, twice the size at the triangle is never exceeded.
    marker.mark(box, 2 * clearance * reach);
  });
  return near;
}

}  // namespace octafront
