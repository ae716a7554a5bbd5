#include "improve/passes/vertex_stars.h"

namespace octafront::improve {

void VertexStars::gather(const EditMesh& mesh, const BoundaryGuide* guide, std::vector<std::uint8_t>& is_worked) {
  for (VertexIndex v = 0; v < mesh.vertices(); ++v) {
    if (is_worked[v] == 0) continue;
    if (mesh.on_boundary(v) && !(guide && guide->may_slide(v)))
      is_worked[v] = 0;
    else
      vertices_.push_back(v);
  }
  stars_ = Groups<HalfFace>(mesh.vertices(), [&](const auto& add) {
    for (TetIndex t = 0; t < mesh.slots(); ++t) {
      if (!mesh.alive(t)) continue;
      for (HalfFace i = 0; i < 4; ++i)
        if (const VertexIndex v = mesh.tet(t)[i]; is_worked[v] != 0) add(v, 4 * t + i);
    }
  });
}

}  // namespace octafront::improve
