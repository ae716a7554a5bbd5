#include "base/mesh/known_surface.h"

#include <octafront/surface_mesh.h>

#include <mutex>
#include <optional>
#include <utility>

namespace octafront {

struct KnownSurface::LazyTree {
  std::once_flag made;
  std::optional<TriangleTree> tree;
};

KnownSurface::KnownSurface(SurfaceMesh mesh, EdgeTable edges, Features features)
    : mesh_(std::move(mesh)),
      edges_(std::move(edges)),
      features_(std::move(features)),
      tree_(std::make_unique<LazyTree>()) {}

KnownSurface::KnownSurface(SurfaceMesh mesh, Features features)
    : KnownSurface(std::move(mesh), EdgeTable{}, std::move(features)) {
  edges_ = make_edge_table(mesh_.points.size(), mesh_.triangles);
}

KnownSurface::KnownSurface(SurfaceMesh mesh, double feature_angle) : KnownSurface(std::move(mesh), Features{}) {
  features_ = detect_features(mesh_, edges_, feature_angle);
}

KnownSurface::KnownSurface(KnownSurface&&) noexcept = default;
KnownSurface::~KnownSurface() = default;

const TriangleTree& KnownSurface::tree() const {
  std::call_once(tree_->made, [&] { tree_->tree.emplace(mesh_); });
  return *tree_->tree;
}

}  // namespace octafront
