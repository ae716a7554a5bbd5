#include "sizing/face_neighbours.h"

#include "mesh/edge_table.h"

namespace octafront {

FaceNeighbours smooth_face_neighbours(const SurfaceMesh& surface, const std::vector<Edge>& features) {
  const EdgeTable table = make_edge_table(surface.points.size(), surface.triangles);
  FaceNeighbours across(surface.triangles.size(), {kNone, kNone, kNone});
  auto feature = features.begin();
  for (std::size_t e = 0; e < table.size(); ++e) {
    while (feature != features.end() && *feature < table.edges[e]) ++feature;
    const bool is_feature = feature != features.end() && *feature == table.edges[e];
    if (is_feature || table.uses(e).size() != 2) continue;
    const HalfEdge g = table.uses(e)[0], h = table.uses(e)[1];
    across[g / 3][g % 3] = h / 3;
    across[h / 3][h % 3] = g / 3;
  }
  return across;
}

}  // namespace octafront
