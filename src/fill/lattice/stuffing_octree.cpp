#include "fill/lattice/stuffing_octree.h"

#include "sizing/field/expected_tets.h"

#include <algorithm>

namespace octafront {

namespace {

/// Leaves around the bounding box that the root must hold.
constexpr double kMarginInLeaves = 4;

/// Of each triangle: its box and a leaf's side around it.
std::vector<Box3> reach_of_triangles(const SurfaceMesh& surface, const SizeField& sizes) {
  std::vector<Box3> reach;
  reach.reserve(surface.triangles.size());
  for (const Triangle& t : surface.triangles) {
    Box3 box;
    double size = 0;
    for (const VertexIndex v : t) {
      box.add(surface.points[v]);
      size = std::max(size, sizes.at(surface.points[v]));
    }
    const double leaf = kLatticeTooLong * kLatticeSidePerEdge * size;
    reach.push_back(box.grown(leaf));
  }
  return reach;
}

/// A cell without triangles lies on one side; where the surface has holes, the cap of one may run through it.
CellSide side_of(OctreeKey cell, const RootCube& root, const SurfaceDomain& domain) {
  const bool inside = domain.side(root.center_of(cell)) >= 0;
  if (!domain.has_holes()) return inside ? CellSide::kInside : CellSide::kOutside;
  if (inside) return CellSide::kMixed;
  const Vec3 lo = root.corner_of(cell);
  const double side = root.side_of(cell);
  for (int c = 0; c < 8; ++c) {
    const Vec3 corner{c & 1 ? lo.x + side : lo.x, c & 2 ? lo.y + side : lo.y, c & 4 ? lo.z + side : lo.z};
    if (domain.side(corner) >= 0) return CellSide::kMixed;
  }
  return CellSide::kOutside;
}

}  // namespace

LatticeOctree build_stuffing_octree(const SurfaceMesh& surface, const SurfaceDomain& domain, const SizeField& sizes,
                                    const RunContext& context) {
  const double leaf_side = kLatticeSidePerEdge * lattice_cell_size(sizes, surface);
  const RootCube root = lattice_root(bounding_box(surface.points), leaf_side, kMarginInLeaves);
  return {root, divide_lattice(
                    root, sizes, reach_of_triangles(surface, sizes),
                    [&](OctreeKey cell) { return side_of(cell, root, domain); }, context)};
}

}  // namespace octafront
