#pragma once

// The last rung of the closing ladder, and the fast way to a coarse exact mesh. See docs/how/recovery.md.

#include <octafront/tet_mesh.h>

#include "base/core/stage.h"

namespace octafront {

struct SurfaceMesh;

/// A cavity whose recovery needs very many points is rather made larger; a whole surface is tried again, with more.
enum class RecoveryPatience { kCavity, kSurface };

/// A conforming tetrahedralisation of the inside of a closed, outward, non-self-intersecting surface, with its
/// triangles as the boundary, exactly, and no size: the last rung, which always ends. The surface may have several
/// components, cavities, and pinched edges or vertices (as cavities of a front have). Points that had to be added lie
/// strictly inside and follow those of the surface in `points`. mesh.boundary is surface.triangles in their order.
/// Vertices that no triangle uses stay in `points` and are used by no tet; equal vertices must be merged, except where
/// the surface touches itself. Counters of `report`: edges and facets missing and recovered, points made, merged,
/// lifted. Of a complex (`sides`) all regions are filled, and its triangles are mesh.boundary and mesh.interfaces, in
/// their order; regions are not numbered. Throws MeshingError, with the place, if no doubles exist for a point that is
/// needed, or if the surface is open, inside out, or has a vertex on another edge or facet. Cost: 4 us per triangle
/// where little is missing, 50-150 on needles.
TetMesh recover_volume(const SurfaceMesh& surface, const Stage& stage,
                       RecoveryPatience patience = RecoveryPatience::kSurface);

}  // namespace octafront
