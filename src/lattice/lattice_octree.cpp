#include "lattice/lattice_octree.h"

#include "lattice/graded_bcc.h"
#include "sizing/make_size_field.h"

#include <algorithm>
#include <cmath>

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>

namespace octafront {

namespace {

// One level of the octree gets exactly this leaf side.
RootCube choose_root(const Box3& box, double leaf_side) {
  const Vec3 extent = box.extent();
  double side = leaf_side;
  while (side < std::max({extent.x, extent.y, extent.z})) side *= 2;
  return {box.center() - Vec3{side, side, side} * 0.5, side};
}

// Cells with fewer triangles are visited in one task.
constexpr std::size_t kTrianglesForTasks = 1000;

class Divider {
 public:
  Divider(const SurfaceMesh& surface, const TriangleTree& triangles, const SizeField& sizes, const RootCube& root,
          const RunContext& context)
      : triangles_(triangles), sizes_(sizes), root_(root), context_(context) {
    boxes_.reserve(surface.triangles.size());
    for (const Triangle& t : surface.triangles) {
      Box3& box = boxes_.emplace_back();
      for (const VertexIndex v : t) box.add(surface.points[v]);
    }
  }

  DividedCells run() {
    std::vector<std::uint32_t> all(boxes_.size());
    for (std::uint32_t t = 0; t < all.size(); ++t) all[t] = t;
    visit_cut(OctreeKey::root(), all);
    // Which thread found a cell is chance; a set of cells has no order.
    DividedCells divided;
    for (const std::vector<OctreeKey>& cells : divided_)
      for (const OctreeKey cell : cells) divided.divide(cell);
    divided.close();
    return divided;
  }

 private:
  Box3 box_of(OctreeKey cell) const {
    const Vec3 lo = root_.corner_of(cell);
    const double side = root_.side_of(cell);
    return {lo, lo + Vec3{side, side, side}};
  }

  bool too_large(OctreeKey cell) const {
    if (cell.level() >= kFinestLatticeLevel) return false;
    const double side = root_.side_of(cell), limit = side / (kLatticeTooLong * kLatticeSidePerEdge);
    if (limit > sizes_.max_size()) return true;
    if (limit <= sizes_.min_size()) return false;
    return sizes_.at(root_.center_of(cell)) < limit;
  }

  // A cell that triangles run through.
  void visit_cut(OctreeKey cell, const std::vector<std::uint32_t>& near) {
    if (!too_large(cell)) return;
    context_.check();
    divided_.local().push_back(cell);
    for_each_child(near.size() > kTrianglesForTasks, [&](int i) {
      const OctreeKey child = cell.child(i);
      const Box3 box = box_of(child);
      std::vector<std::uint32_t> here;
      for (const std::uint32_t t : near)
        if (boxes_[t].overlaps(box)) here.push_back(t);
      if (!here.empty())
        visit_cut(child, here);
      else if (triangles_.contains(box.center()))
        visit_inside(child);
    });
  }

  void visit_inside(OctreeKey cell) {
    if (!too_large(cell)) return;
    divided_.local().push_back(cell);
    for (int i = 0; i < 8; ++i) visit_inside(cell.child(i));
  }

  template <class Visit>
  static void for_each_child(bool as_tasks, const Visit& visit) {
    if (as_tasks)
      tbb::parallel_for(0, 8, visit);
    else
      for (int i = 0; i < 8; ++i) visit(i);
  }

  const TriangleTree& triangles_;
  const SizeField& sizes_;
  RootCube root_;
  const RunContext& context_;
  std::vector<Box3> boxes_;
  tbb::enumerable_thread_specific<std::vector<OctreeKey>> divided_;
};

}  // namespace

LatticeOctree build_lattice_octree(const SurfaceMesh& surface, const TriangleTree& triangles, const SizeField& sizes,
                                   const RunContext& context) {
  const double leaf_side = kLatticeSidePerEdge * lattice_cell_size(sizes, surface);
  const RootCube root = choose_root(bounding_box(surface.points), leaf_side);
  return {root, Divider(surface, triangles, sizes, root, context).run().tree()};
}

}  // namespace octafront
