#include "improve/passes/poor_tets.h"

namespace octafront::improve {

std::vector<TetIndex> tets_below(const EditMesh& mesh, float threshold) {
  std::vector<TetIndex> found;
  for (TetIndex t = 0; t < mesh.slots(); ++t)
    if (mesh.shape(t).score < threshold) found.push_back(t);
  return found;
}

}  // namespace octafront::improve
