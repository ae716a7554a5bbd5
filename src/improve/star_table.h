#pragma once

#include "core/groups.h"
#include "improve/edit_mesh.h"

#include <span>

namespace octafront::improve {

/// The stars of all vertices at once, for passes that change no connection: quicker than walking each.
class StarTable {
 public:
  explicit StarTable(const EditMesh& mesh)
      : stars_(group_by_owner(mesh.vertices(), 4 * mesh.slots(),
                              [&](HalfFace h) { return mesh.alive(h / 4) ? mesh.tet(h / 4)[h % 4] : kNoOwner; })) {}

  /// The half-faces opposite v of the tets around it, in order of the tets.
  std::span<const HalfFace> of(VertexIndex v) const { return stars_[v]; }

 private:
  Groups<HalfFace> stars_;
};

}  // namespace octafront::improve
