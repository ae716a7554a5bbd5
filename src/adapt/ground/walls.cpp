#include "adapt/ground/ground.h"

#include <utility>

namespace octafront::adapt {
namespace {

/// Whether both triangles run the same way through the edge that they share.
bool run_alike(const Triangle& a, const Triangle& b) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (a[i] == b[j] && a[(i + 1) % 3] == b[(j + 1) % 3]) return true;
  return false;
}

}  // namespace

void turn_alike(Walls& walls) {
  SurfaceMesh& surface = walls.surface;
  EdgeTable table = make_edge_table(surface.points.size(), surface.triangles);
  const RawVector<std::uint32_t> edge_of = table.edge_of_half_edge();
  std::vector<std::uint8_t> seen(walls.outer);
  std::vector<std::uint32_t> queue;
  for (std::uint32_t first = 0; first < seen.size(); ++first) {
    if (seen[first]) continue;
    seen[first] = 1;
    queue.assign(1, first);
    for (std::size_t k = 0; k < queue.size(); ++k)
      for (std::uint32_t h = 3 * queue[k]; h < 3 * queue[k] + 3; ++h) {
        const auto uses = table.uses(edge_of[h]);
        if (uses.size() != 2) continue;
        const std::uint32_t o = (uses[0] / 3 == queue[k] ? uses[1] : uses[0]) / 3;
        if (seen[o] || surface.patch[o] != surface.patch[queue[k]]) continue;
        seen[o] = 1;
        queue.push_back(o);
        if (run_alike(surface.triangles[queue[k]], surface.triangles[o]))
          std::swap(surface.triangles[o][1], surface.triangles[o][2]);
      }
  }
  walls.edges = make_edge_table(surface.points.size(), surface.triangles);
}

}  // namespace octafront::adapt
