#pragma once

#include <octafront/report.h>
#include <octafront/run_context.h>
#include <octafront/surface_mesh.h>
#include <octafront/tet_mesh.h>

namespace octafront {

/// A conforming tetrahedralisation of the inside of a closed, outward, non-self-intersecting surface, with its
/// triangles as the boundary, exactly, and no size: the last rung, which always ends. The surface may have several
/// components, cavities, and pinched edges or vertices (as cavities of a front have). Points that had to be added lie
/// strictly inside and follow those of the surface in `points`. mesh.boundary is surface.triangles in their order.
/// Throws MeshingError if no doubles exist for a point that is needed.
TetMesh recover_volume(const SurfaceMesh& surface, const RunContext& context, StageReport& report);

}  // namespace octafront
