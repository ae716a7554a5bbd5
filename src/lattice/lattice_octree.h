#pragma once

#include <octafront/run_context.h>
#include <octafront/size_field.h>
#include <octafront/surface_mesh.h>

#include "geometry/triangle_tree.h"
#include "sizing/octree.h"

namespace octafront {

/// The octree of a lattice: its leaves inside the surface have the side that the lattice needs for the wanted edge
/// length; outside they stay coarse.
struct LatticeOctree {
  RootCube root;
  Octree tree;
};

/// Cube side of the body-centred cubic lattice over the mean length of its edges: of 14 edges a cube, 6 are as long as
/// its side and 8 are sqrt(3) / 2 of it.
inline constexpr double kLatticeSidePerEdge = 14 / (6 + 8 * 0.86602540378443865);

LatticeOctree build_lattice_octree(const SurfaceMesh& surface, const TriangleTree& triangles, const SizeField& sizes,
                                   const RunContext& context);

}  // namespace octafront
