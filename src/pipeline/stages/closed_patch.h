#pragma once

#include <octafront/ids.h>
#include <octafront/tet_mesh.h>

#include "base/geometry/triangle_tree.h"
#include "base/mesh/edge_table.h"

#include <cstdint>
#include <vector>

namespace octafront {

struct SurfaceMesh;

/// What repair closed (kClosedByRepair). Its rim is no line of the body where the surface goes on smoothly: no element
/// need follow it. So it is meshed as a part of the patches around it, and named again in the mesh.
struct ClosedPatch {
  std::uint32_t patch = kNone;         ///< kNone: nothing was closed
  std::vector<std::uint8_t> is_in_it;  ///< per triangle of the input; empty: none
};

/// Finds the patch by its name and gives its triangles to the patches around them.
ClosedPatch take_closed_patch(SurfaceMesh& surface, const EdgeTable& edges);

/// The triangles of the boundary that lie on it are of that patch again. If there are none, its name goes, if it is the
/// last. `tree`: over the triangles of the input.
void name_closed_patch(const ClosedPatch& closed, const TriangleTree& tree, SurfaceMesh& boundary);
void name_closed_patch(const ClosedPatch& closed, const TriangleTree& tree, TetMesh& mesh);

}  // namespace octafront
