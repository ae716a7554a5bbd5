#pragma once

#include <octafront/tet_mesh.h>

#include "base/core/stage.h"
#include "base/geometry/leeway.h"
#include "base/shared/shared_tets.h"
#include "improve/shape/flat_walls.h"
#include "improve/shape/input_force.h"

namespace octafront {

struct SurfaceMesh;

/// What raise_flat() did.
struct RaisedFlat {
  std::uint64_t vertices = 0;  ///< that moved
  double largest_move = 0;     ///< input units
};

/// What holds corners back.
struct RaiseLimits {
  double distance = 0;                         ///< input units
  const Leeway* leeway = nullptr;              ///< no farther than that either; null: whatever it is
  improve::FlatWalls* walls = nullptr;         ///< whose vertices stay; null: there are none
  const improve::InputForce* force = nullptr;  ///< elements of thin walls and wedges stay as they are; null: none are
  const TriangleTree* input = nullptr;         ///< vertices of surfaces stay near these triangles; null: near none
  double from_input = 0;                       ///< how near; input units
  const std::vector<VertexIndex>* fixed = nullptr;  ///< vertices that stay; null: there are none
};

/// Moves corners of elements below beta .2 or 10 degrees, where those around lack less in sum then. Where sheets nearly
/// touch, all four corners lie on surfaces, along which no place is better; they leave them, within the limits and by
/// .3 of the edges around at most. No element is inverted and no triangle
/// crosses another (exact signs). `filled`: the surface or complex that the mesh fills, whose vertices are the mesh's
/// first ones. `tets`: what of them each of several ranks has, in stretches.
RaisedFlat raise_flat(TetMesh& mesh, const SurfaceMesh& filled, const RaiseLimits& limits, const Stage& stage,
                      Tets tets = Tets::kAll);

}  // namespace octafront
