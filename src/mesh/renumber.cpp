#include "mesh/renumber.h"

#include <algorithm>

namespace octafront {

void keep_numbered(std::vector<Vec3>& points, std::vector<VertexIndex>& number) {
  VertexIndex next = 0;
  for (std::size_t v = 0; v < points.size(); ++v) {
    if (number[v] == kNone) continue;
    points[next] = points[v];
    number[v] = next++;
  }
  points.resize(next);
}

void drop_unused_points(TetMesh& mesh, std::size_t kept) {
  std::vector<VertexIndex> number(mesh.points.size(), kNone);
  std::fill_n(number.begin(), kept, 0);
  for (const Tet& t : mesh.tets)
    for (const VertexIndex v : t) number[v] = 0;
  keep_numbered(mesh.points, number);
  renumber(mesh.tets, number);
  renumber(mesh.boundary, number);
}

}  // namespace octafront
