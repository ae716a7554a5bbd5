#pragma once

#include "base/geometry/live_triangles.h"
#include "surface/edits/working_mesh.h"
#include "surface/lines/seams.h"

#include <vector>

namespace octafront::surface {

/// The working mesh as LiveTriangles looks at it: sewn, without backs. Seams must not change while it is used.
class SewnMesh {
 public:
  explicit SewnMesh(const WorkingMesh& mesh) : mesh_(mesh) {
    if (mesh.first_back != kNone) sewn_ = sewn_vertices(mesh);
  }

  std::size_t triangle_count() const { return mesh_.triangle_count(); }
  bool is_removed(std::size_t t) const { return mesh_.is_removed(t) || mesh_.is_back(t); }
  Vec3 corner(std::uint32_t t, int i) const { return mesh_.corner(t, i); }
  Triangle triangle(std::uint32_t t) const {
    const Triangle own = mesh_.triangle(t);
    return {vertex(own[0]), vertex(own[1]), vertex(own[2])};
  }
  IdTriangle sewn(const IdTriangle& t) const {
    return {{vertex(t.ids[0]), vertex(t.ids[1]), vertex(t.ids[2])}, t.corners};
  }
  /// Those that came later are not on seams.
  VertexIndex vertex(VertexIndex v) const { return v < sewn_.size() ? sewn_[v] : v; }

 private:
  const WorkingMesh& mesh_;
  std::vector<VertexIndex> sewn_;
};

}  // namespace octafront::surface
