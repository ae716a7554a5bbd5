#pragma once

#include <octafront/surface_mesh.h>

#include "base/geometry/triangle_tree.h"
#include "base/mesh/features.h"

#include <span>
#include <vector>

namespace octafront::improve {

/// The surface that the boundary of a mesh stands for; the boundary is a 2-manifold, but for edges and vertices where
/// that of a complex touches itself: there it stays. Everything must outlive the guide.
struct BoundaryInput {
  const SurfaceMesh& surface;  ///< clean
  const TriangleTree& tree;    ///< over its triangles
  const Features& features;    ///< of it
  const Features& of_mesh;     ///< of the boundary of the mesh, in the mesh's numbering
  double tolerance = 0;        ///< the boundary may stray so far where that rids it of what keeps elements poor
  /// Vertices of the mesh whose triangles stray nearly as far as they may: they do not slide, nor do their edges turn.
  std::vector<VertexIndex> pinned = {};
  /// Per triangle of `surface` how far the boundary may stray there, where that is less; empty: so nowhere.
  std::span<const double> bound = {};
  /// Vertices of the mesh that stay where they are, as do the edges around them.
  std::vector<VertexIndex> frozen = {};
};

}  // namespace octafront::improve
