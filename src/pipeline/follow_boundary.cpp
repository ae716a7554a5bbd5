#include "pipeline/follow_boundary.h"

#include "geometry/triangle_tree.h"

namespace octafront {

void renew_sources(TetMesh& mesh, const SurfaceMesh& before, const SurfaceMesh& input,
                   const std::vector<std::uint32_t>& face_of_triangle) {
  if (mesh.source.empty()) return;
  const TriangleTree tree(input);
  for (std::size_t t = 0; t < mesh.boundary.size(); ++t) {
    const auto& [a, b, c] = mesh.boundary[t];
    const auto& [x, y, z] = before.triangles[t];
    if (mesh.points[a] == before.points[x] && mesh.points[b] == before.points[y] && mesh.points[c] == before.points[z])
      continue;
    const Vec3 middle = (mesh.points[a] + mesh.points[b] + mesh.points[c]) / 3;
    mesh.source[t] = face_of_triangle[tree.nearest(middle).triangle];
  }
}

}  // namespace octafront
