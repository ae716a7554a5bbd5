#pragma once

#include <octafront/run_context.h>
#include <octafront/size_field.h>

#include "base/geometry/triangle_tree.h"
#include "sizing/field/octree.h"

#include <functional>
#include <vector>

namespace octafront {

struct SurfaceMesh;

/// The octree of a lattice: its leaves inside the surface have the side that the lattice needs for the wanted edge
/// length; outside they stay coarse.
struct LatticeOctree {
  RootCube root;
  Octree tree;
};

/// Cube side of the body-centred cubic lattice over the mean length of its edges: of 14 edges a cube, 6 are as long as
/// its side and 8 are sqrt(3) / 2 of it.
inline constexpr double kLatticeSidePerEdge = 14 / (6 + 8 * 0.86602540378443865);

/// A cube about the box with a margin of `margin` leaves, so that one level of its octree has leaves of `leaf_side`.
RootCube lattice_root(const Box3& box, double leaf_side, double margin = 0);

/// On which side of a surface a cell lies that none of its triangles comes near to; kMixed: its children have to say.
enum class CellSide { kOutside, kInside, kMixed };

/// Divides cells as long as they are larger than the sizes want, where `reach`, a box about each triangle, or the
/// inside comes; side_of(cell) is asked where no box reaches, by several threads at once.
Octree divide_lattice(const RootCube& root, const SizeField& sizes, const std::vector<Box3>& reach,
                      const std::function<CellSide(OctreeKey)>& side_of, const RunContext& context);

/// `hull`: of the triangles between the regions of the surface and the outside.
LatticeOctree build_lattice_octree(const SurfaceMesh& surface, const TriangleTree& hull, const SizeField& sizes,
                                   const RunContext& context);

}  // namespace octafront
