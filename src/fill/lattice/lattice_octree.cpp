#include "fill/lattice/lattice_octree.h"

#include "base/core/parallel.h"
#include "base/geometry/doubtful_parts.h"
#include "base/geometry/triangle_box.h"
#include "fill/lattice/graded_bcc.h"
#include "sizing/field/expected_tets.h"

#include <algorithm>
#include <numeric>

namespace octafront {

namespace {

// Cells with fewer triangles are visited in one task.
constexpr std::size_t kTrianglesForTasks = 1000;
// The box about a longer triangle holds far more cells than come near to it: that of a needle askew is most of its
// body's.
constexpr double kLongInLeaves = 8;
// Nor are parts smaller than this share of the body: leaves may be, at one place.
constexpr double kLeastPartOfBody = 1.0 / 256;

Box3 box_of(const RootCube& root, OctreeKey cell) {
  const Vec3 lo = root.corner_of(cell);
  const double side = root.side_of(cell);
  return {lo, lo + Vec3{side, side, side}};
}

/// Boxes about triangles, and about the parts of those of which corners are farther than `reach` from the middle.
std::vector<Box3> boxes_of_parts(const SurfaceMesh& surface, double reach) {
  std::vector<Box3> boxes;
  boxes.reserve(surface.triangles.size());
  const auto take = [&](PartCorners part, Vec3, double has) {
    if (has > reach) return Part::kDivide;
    boxes.push_back(box_of_part(part));
    return Part::kWithin;
  };
  for (const auto& [a, b, c] : surface.triangles)
    for_each_doubtful_part({surface.points[a], surface.points[b], surface.points[c]}, take, [](Vec3) { return true; });
  return boxes;
}

/// What the sizes ask of cells.
struct CellSizes {
  const RootCube& root;
  const SizeField& sizes;

  bool too_large(OctreeKey cell) const {
    if (cell.level() >= kFinestLatticeLevel) return false;
    const double side = root.side_of(cell), limit = side / (kLatticeTooLong * kLatticeSidePerEdge);
    if (limit > sizes.max_size()) return true;
    if (limit <= sizes.min_size()) return false;
    return sizes.at(root.center_of(cell)) < limit;
  }
};

/// Leaves that stick out into leaves of another size become like these: between sizes the front fills belts, whose
/// elements are the poorest, and there are the fewest where belts are plain.
class Tidier {
 public:
  Tidier(Octree tree, const CellSizes& wanted) : tree_(std::move(tree)), wanted_(wanted) {}

  Octree run() const {
    std::vector<Change> change(tree_.size());
    parallel_for(tree_.size(), [&](std::size_t i) { change[i] = change_at(i); });
    DividedCells cells = divided_cells(tree_, [&](std::size_t first) { return change[first] != Change::kMerge; });
    for (std::size_t i = 0; i < tree_.size(); ++i)
      if (change[i] == Change::kDivide) cells.divide(tree_.leaf(i));
    cells.close();
    return cells.tree();
  }

 private:
  static constexpr int kMostFaces = 4;
  enum class Change : std::uint8_t { kNone, kDivide, kMerge };  ///< kMerge: the first of eight leaves

  Change change_at(std::size_t i) const {
    const OctreeKey leaf = tree_.leaf(i);
    const auto is_finer = [&](OctreeKey across) { return across.level() > leaf.level(); };
    if (leaf.level() < kFinestLatticeLevel && faces(leaf, is_finer) >= kMostFaces) return Change::kDivide;
    const bool is_first = leaf.level() > 0 && leaf.child_number() == 0 && i + 7 < tree_.size();
    if (!is_first || tree_.leaf(i + 7) != leaf.parent().child(7)) return Change::kNone;
    // Outside the surface leaves stay coarse, and count for nothing.
    const auto is_coarse = [&](OctreeKey across) {
      return across.level() < leaf.level() && !wanted_.too_large(across);
    };
    return faces(leaf.parent(), is_coarse) >= kMostFaces ? Change::kMerge : Change::kNone;
  }

  /// Across how many of the cell's faces the (first) leaf passes the test.
  template <class Test>
  int faces(OctreeKey cell, const Test& test) const {
    int n = 0;
    for (const int by : {-1, 1})
      for (int axis = 0; axis < 3; ++axis) {
        const OctreeKey across = cell.neighbour(axis == 0 ? by : 0, axis == 1 ? by : 0, axis == 2 ? by : 0);
        n += across.is_valid() && test(tree_.leaf(tree_.find(across)));
      }
    return n;
  }

  const Octree tree_;
  const CellSizes wanted_;
};

class CellDivider {
 public:
  CellDivider(const RootCube& root, const SizeField& sizes, const std::vector<Box3>& reach,
              const std::function<CellSide(OctreeKey)>& side_of, const RunContext& context)
      : root_(root), wanted_{root, sizes}, reach_(reach), side_of_(side_of), context_(context) {}

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
  // A cell that triangles come near to.
  void visit_near(OctreeKey cell, const std::vector<std::uint32_t>& near) {
    if (!wanted_.too_large(cell)) return;
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
    if (!wanted_.too_large(cell)) return;
    const CellSide side = side_of_(cell);
    if (side == CellSide::kOutside) return;
    if (side == CellSide::kInside) return visit_inside(cell);
    context_.check();
    divided_.local().push_back(cell);
    for (int i = 0; i < 8; ++i) visit_clear(cell.child(i));
  }

  void visit_inside(OctreeKey cell) {
    if (!wanted_.too_large(cell)) return;
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
  const CellSizes wanted_;
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
  return CellDivider(root, sizes, reach, side_of, context).run();
}

LatticeOctree build_lattice_octree(const SurfaceMesh& surface, const TriangleTree& hull, const SizeField& sizes,
                                   const RunContext& context) {
  const double leaf_side = kLatticeSidePerEdge * lattice_cell_size(sizes, surface);
  const RootCube root = lattice_root(bounding_box(surface.points), leaf_side);
  const std::vector<Box3> boxes = boxes_of_parts(
      surface, std::max(kLongInLeaves * leaf_side, kLeastPartOfBody * bounding_box(surface.points).diagonal()));
  const auto side_of = [&](OctreeKey cell) {
    return hull.contains(box_of(root, cell).center()) ? CellSide::kInside : CellSide::kOutside;
  };
  return {root, Tidier(divide_lattice(root, sizes, boxes, side_of, context), {root, sizes}).run()};
}

}  // namespace octafront
