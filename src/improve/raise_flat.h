#pragma once

#include <octafront/surface_mesh.h>
#include <octafront/tet_mesh.h>

#include "core/stage.h"

namespace octafront {

/// What raise_flat() did.
struct RaisedFlat {
  std::uint64_t vertices = 0;  ///< that moved
  double largest_move = 0;     ///< input units
};

/// Moves corners of elements below beta .2 or 10 degrees, where those around lack less in sum then. Where sheets nearly
/// touch, all four corners lie on surfaces, along which no place is better; they leave them, by `limit` (input units)
/// and .3 of the edges around at most. Vertices of flat faces stay. No element is inverted and no triangle crosses
/// another (exact signs). `filled`: the surface or complex that the mesh fills, whose vertices are the mesh's first
/// ones.
RaisedFlat raise_flat(TetMesh& mesh, const SurfaceMesh& filled, double limit, const Stage& stage);

}  // namespace octafront
