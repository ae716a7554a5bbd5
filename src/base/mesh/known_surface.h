#pragma once

#include <octafront/surface_mesh.h>

#include "base/geometry/triangle_tree.h"
#include "base/mesh/edge_table.h"
#include "base/mesh/features.h"

#include <memory>

namespace octafront {

/// A surface that changes no more, with what stage after stage asks of it: each is found once and handed down. It is
/// clean (see surface_mesh.h) but for the octree method, which takes others too.
class KnownSurface {
 public:
  /// `edges` as make_edge_table() makes them of `mesh`.
  KnownSurface(SurfaceMesh mesh, EdgeTable edges, Features features);
  KnownSurface(SurfaceMesh mesh, Features features);
  KnownSurface(SurfaceMesh mesh, double feature_angle);
  KnownSurface(KnownSurface&&) noexcept;
  ~KnownSurface();

  const SurfaceMesh& mesh() const { return mesh_; }
  const EdgeTable& edges() const { return edges_; }
  const Features& features() const { return features_; }
  /// Over the triangles. Made when it is first asked for: many runs do without. Safe on any number of threads.
  const TriangleTree& tree() const;

 private:
  struct LazyTree;

  SurfaceMesh mesh_;
  EdgeTable edges_;
  Features features_;
  std::unique_ptr<LazyTree> tree_;
};

}  // namespace octafront
