#pragma once

// Where the nodes of the boundary would like to be: corners and mid-side nodes on the smooth surface.

#include <octafront/tet_mesh.h>

#include "base/geometry/true_geometry.h"
#include "improve/curved/smooth_surface.h"

#include <vector>

namespace octafront::curved {

/// A corner that the smooth surface would have elsewhere.
struct CornerMove {
  VertexIndex vertex;
  Vec3 by;
};

/// An edge of the boundary that would be curved: its mid-side node lies off the middle between its ends, when those are
/// where they want to be. The edge keeps this shape where they are not.
struct EdgeBend {
  Edge edge;
  Vec3 by;
};

struct Bends {
  std::vector<CornerMove> corners;  ///< ascending
  std::vector<EdgeBend> edges;      ///< ascending
  std::size_t too_far = 0;          ///< corners that stay, for they would have to move too far
};

/// `mesh` is linear. `sharp`: feature edges of its boundary, sorted, those between patches too. In parallel.
Bends find_bends(const TetMesh& mesh, const std::vector<Edge>& sharp, SmoothSurface& surface);

/// The same where the true geometry is known; the patches of the mesh are its patches. Edges bend as they do once their
/// corners are on it. In parallel.
Bends find_bends(const TetMesh& mesh, const TrueGeometry& geometry);

}  // namespace octafront::curved
