#pragma once

#include "improve/edit_mesh.h"

#include <span>
#include <vector>

namespace octafront::improve {

/// The stars of all vertices at once, for passes that change no connection: quicker than walking each.
class StarTable {
 public:
  explicit StarTable(const EditMesh& mesh) : first_(mesh.vertices() + 1, 0) {
    for (TetIndex t = 0; t < mesh.slots(); ++t)
      if (mesh.alive(t))
        for (const VertexIndex v : mesh.tet(t)) ++first_[v];
    std::uint32_t end = 0;
    for (std::uint32_t& f : first_) f = end += f;
    faces_.resize(end);
    for (TetIndex t = static_cast<TetIndex>(mesh.slots()); t-- > 0;)
      if (mesh.alive(t))
        for (int i = 0; i < 4; ++i) faces_[--first_[mesh.tet(t)[i]]] = 4 * t + i;
  }

  /// The half-faces opposite v of the tets around it, in order of the tets.
  std::span<const HalfFace> of(VertexIndex v) const {
    return {faces_.data() + first_[v], faces_.data() + first_[v + 1]};
  }

 private:
  std::vector<std::uint32_t> first_;
  std::vector<HalfFace> faces_;
};

}  // namespace octafront::improve
