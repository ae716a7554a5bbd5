#include "lattice/lattice_octree.h"

#include "core/parallel.h"
#include "lattice/graded_bcc.h"
#include "sizing/make_size_field.h"

#include <algorithm>
#include <numeric>

namespace octafront {

namespace {

// Cells with fewer triangles are visited in one task.
constexpr std::size_t kTrianglesForTasks = 1000;

Box3 box_of(const RootCube& root, OctreeKey cell) {
  const Vec3 lo = root.corner_of(cell);
  const double side = root.side_of(cell);
  return {lo, lo + Vec3{side, side, side}};
}

class Divider {
 public:
  Divider(const RootCube& root, const SizeField& sizes, const std::vector<Box3>& reach,
          const std::function<CellSide(OctreeKey)>& side_of, const RunContext& context)
      : root_(root), sizes_(sizes), reach_(reach), side_of_(side_of), context_(context) {}

  Octree run() {
    std::vector<std::uint32_t> all(reach_.size());
    std::iota(all.begin(), all.end(), 0u);
    visit_near(OctreeKey::root(), all);
    // Which thread found a cell is chance; a set of cells has no order.
    DividedCells divided;
    divided_.for_each([&](const std::vector<OctreeKey>& cells) {
      for (const OctreeKey cell : cells) divided.divide(cell);
    });
    divided.close();
    return divided.tree();
  }

 private:
  bool too_large(OctreeKey cell) const {
    if (cell.level() >= kFinestLatticeLevel) return false;
    const double side = root_.side_of(cell), limit = side / (kLatticeTooLong * kLatticeSidePerEdge);
    if (limit > sizes_.max_size()) return true;
    if (limit <= sizes_.min_size()) return false;
    return sizes_.at(root_.center_of(cell)) < limit;
  }

  // A cell that triangles come near to.
  void visit_near(OctreeKey cell, const std::vector<std::uint32_t>& near) {
    if (!too_large(cell)) return;
    context_.check();
    divided_.local().push_back(cell);
    for_each_child(near.size() > kTrianglesForTasks, [&](int i) {
      const OctreeKey child = cell.child(i);
      const Box3 box = box_of(root_, child);
      std::vector<std::uint32_t> here;
      for (const std::uint32_t t : near)
        if (reach_[t].overlaps(box)) here.push_back(t);
      if (here.empty())
        visit_clear(child);
      else
        visit_near(child, here);
    });
  }

  void visit_clear(OctreeKey cell) {
    if (!too_large(cell)) return;
    const CellSide side = side_of_(cell);
    if (side == CellSide::kOutside) return;
    if (side == CellSide::kInside) return visit_inside(cell);
    context_.check();
    divided_.local().push_back(cell);
    for (int i = 0; i < 8; ++i) visit_clear(cell.child(i));
  }

  void visit_inside(OctreeKey cell) {
    if (!too_large(cell)) return;
    divided_.local().push_back(cell);
    for (int i = 0; i < 8; ++i) visit_inside(cell.child(i));
  }

  template <class Visit>
  static void for_each_child(bool as_tasks, const Visit& visit) {
    if (as_tasks)
      parallel_for(8, [&](std::size_t i) { visit(static_cast<int>(i)); });
    else
      for (int i = 0; i < 8; ++i) visit(i);
  }

  const RootCube& root_;
  const SizeField& sizes_;
  const std::vector<Box3>& reach_;
  const std::function<CellSide(OctreeKey)>& side_of_;
  const RunContext& context_;
  PerThread<std::vector<OctreeKey>> divided_;
};

}  // namespace

RootCube lattice_root(const Box3& box, double leaf_side, double margin) {
  const Vec3 extent = box.extent();
  const double needed = std::max({extent.x, extent.y, extent.z}) + 2 * margin * leaf_side;
  double side = leaf_side;
  while (side < needed) side *= 2;
  return {box.center() - Vec3{side, side, side} * 0.5, side};
}

Octree divide_lattice(const RootCube& root, const SizeField& sizes, const std::vector<Box3>& reach,
                      const std::function<CellSide(OctreeKey)>& side_of, const RunContext& context) {
  return Divider(root, sizes, reach, side_of, context).run();
}

LatticeOctree build_lattice_octree(const SurfaceMesh& surface, const TriangleTree& hull, const SizeField& sizes,
                                   const RunContext& context) {
  const double leaf_side = kLatticeSidePerEdge * lattice_cell_size(sizes, surface);
  const RootCube root = lattice_root(bounding_box(surface.points), leaf_side);
  std::vector<Box3> boxes;
  boxes.reserve(surface.triangles.size());
  for (const Triangle& t : surface.triangles) {
    Box3& box = boxes.emplace_back();
    for (const VertexIndex v : t) box.add(surface.points[v]);
  }
  const auto side_of = [&](OctreeKey cell) {
    return hull.contains(box_of(root, cell).center()) ? CellSide::kInside : CellSide::kOutside;
  };
  return {root, divide_lattice(root, sizes, boxes, side_of, context)};
}

}  // namespace octafront
