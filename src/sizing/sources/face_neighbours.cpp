#include "sizing/sources/face_neighbours.h"

namespace octafront {

FaceNeighbours smooth_face_neighbours(const EdgeTable& table, const std::vector<Edge>& features) {
  FaceNeighbours across(table.half_edges.size() / 3, {kNone, kNone, kNone});
  auto feature = features.begin();
  for (std::size_t e = 0; e < table.size(); ++e) {
    while (feature != features.end() && *feature < table.edges[e]) ++feature;
    const bool is_feature = feature != features.end() && *feature == table.edges[e];
    if (table.uses(e).size() != 2 || is_feature) continue;
    const HalfEdge g = table.uses(e)[0], h = table.uses(e)[1];
    across[g / 3][g % 3] = h / 3;
    across[h / 3][h % 3] = g / 3;
  }
  return across;
}

}  // namespace octafront
