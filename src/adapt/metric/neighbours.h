#pragma once

#include <octafront/tet_mesh.h>

#include "base/core/groups.h"

namespace octafront::adapt {

/// Per vertex those at its edges, each once for each element that has the edge.
inline Groups<> neighbours_of(const TetMesh& mesh) {
  return Groups<>(mesh.points.size(), [&](const auto& add) {
    for (const Tet& t : mesh.tets)
      for (const VertexIndex v : t)
        for (const VertexIndex w : t)
          if (v != w) add(v, w);
  });
}

/// Throws InputError for elements of second order.
void require_linear(const TetMesh& mesh);

}  // namespace octafront::adapt
