#pragma once

#include "core/groups.h"
#include "improve/edit_mesh.h"

#include <span>

namespace octafront::improve {

/// The stars of all vertices at once, for passes that change no connection: quicker than walking each.
class StarTable {
 public:
  explicit StarTable(const EditMesh& mesh)
      : stars_(mesh.vertices(), [&](const auto& add) {
          for (TetIndex t = 0; t < mesh.slots(); ++t)
            if (mesh.alive(t))
              for (int i = 0; i < 4; ++i) add(mesh.tet(t)[i], 4 * t + static_cast<HalfFace>(i));
        }) {}

  /// The half-faces opposite v of the tets around it, in order of the tets.
  std::span<const HalfFace> of(VertexIndex v) const { return stars_[v]; }

 private:
  Groups<HalfFace> stars_;
};

}  // namespace octafront::improve
