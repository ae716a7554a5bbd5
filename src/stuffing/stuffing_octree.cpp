#include "stuffing/stuffing_octree.h"

#include "lattice/graded_bcc.h"
#include "lattice/lattice_octree.h"
#include "sizing/make_size_field.h"

#include <algorithm>

namespace octafront {

namespace {

/// Leaves around the bounding box that the root must hold.
constexpr double kMarginInLeaves = 4;

RootCube choose_root(const Box3& box, double leaf_side) {
  const Vec3 extent = box.extent();
  const double needed = std::max({extent.x, extent.y, extent.z}) + 2 * kMarginInLeaves * leaf_side;
  double side = leaf_side;
  while (side < needed) side *= 2;
  return {box.center() - Vec3{side, side, side} * 0.5, side};
}

class Divider {
 public:
  Divider(const SurfaceMesh& surface, const SurfaceDomain& domain, const SizeField& sizes, const RootCube& root,
          const RunContext& context)
      : domain_(domain), sizes_(sizes), root_(root), context_(context) {
    reach_.reserve(surface.triangles.size());
    for (const Triangle& t : surface.triangles) {
      Box3 box;
      double size = 0;
      for (const VertexIndex v : t) {
        box.add(surface.points[v]);
        size = std::max(size, sizes.at(surface.points[v]));
      }
      const double leaf = kLatticeTooLong * kLatticeSidePerEdge * size;
      reach_.push_back({box.lo - Vec3{leaf, leaf, leaf}, box.hi + Vec3{leaf, leaf, leaf}});
    }
  }

  Octree run() {
    std::vector<std::uint32_t> all(reach_.size());
    for (std::uint32_t t = 0; t < all.size(); ++t) all[t] = t;
    visit_near(OctreeKey::root(), all);
    divided_.close();
    return divided_.tree();
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

  /// A cell that triangles come near to.
  void visit_near(OctreeKey cell, const std::vector<std::uint32_t>& near) {
    if (!too_large(cell)) return;
    context_.check();
    divided_.divide(cell);
    for (int i = 0; i < 8; ++i) {
      const OctreeKey child = cell.child(i);
      const Box3 box = box_of(child);
      std::vector<std::uint32_t> here;
      for (const std::uint32_t t : near)
        if (reach_[t].overlaps(box)) here.push_back(t);
      if (here.empty())
        visit_clear(child);
      else
        visit_near(child, here);
    }
  }

  /// A cell without triangles lies on one side; where the surface has holes, the cap of one may run through it.
  void visit_clear(OctreeKey cell) {
    if (!too_large(cell)) return;
    const bool inside = domain_.side(root_.center_of(cell)) >= 0;
    if (!domain_.has_holes()) {
      if (inside) visit_inside(cell);
      return;
    }
    const Box3 box = box_of(cell);
    bool mixed = false;
    for (int c = 0; c < 8 && !mixed; ++c) {
      const Vec3 corner{c & 1 ? box.hi.x : box.lo.x, c & 2 ? box.hi.y : box.lo.y, c & 4 ? box.hi.z : box.lo.z};
      mixed = (domain_.side(corner) >= 0) != inside;
    }
    if (!inside && !mixed) return;
    context_.check();
    divided_.divide(cell);
    for (int i = 0; i < 8; ++i) visit_clear(cell.child(i));
  }

  void visit_inside(OctreeKey cell) {
    if (!too_large(cell)) return;
    divided_.divide(cell);
    for (int i = 0; i < 8; ++i) visit_inside(cell.child(i));
  }

  const SurfaceDomain& domain_;
  const SizeField& sizes_;
  RootCube root_;
  const RunContext& context_;
  std::vector<Box3> reach_;  ///< of each triangle: its box and a leaf's side around it
  DividedCells divided_;
};

}  // namespace

StuffingOctree build_stuffing_octree(const SurfaceMesh& surface, const SurfaceDomain& domain, const SizeField& sizes,
                                     const RunContext& context) {
  const double leaf_side = kLatticeSidePerEdge * lattice_cell_size(sizes, surface);
  const RootCube root = choose_root(bounding_box(surface.points), leaf_side);
  return {root, Divider(surface, domain, sizes, root, context).run()};
}

}  // namespace octafront
