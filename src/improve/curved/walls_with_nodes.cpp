#include "base/core/renumber.h"
#include "base/mesh/face_nodes.h"
#include "improve/curved/curved.h"

namespace octafront {

namespace {

/// visit(triangle) for each triangle between nodes of the face; they run as the face does.
template <class Visit>
void divide(const FaceNodes& nodes, const Triangle& face, int order, const Visit& visit) {
  using Weights = FaceNodes::Weights;
  const auto triangle = [&](const Weights& a, const Weights& b, const Weights& c) {
    return Triangle{nodes.node(face, a), nodes.node(face, b), nodes.node(face, c)};
  };
  for (int i = 0; i < order; ++i)
    for (int j = 0; i + j < order; ++j) {
      const int k = order - 1 - i - j;
      visit(triangle({i + 1, j, k}, {i, j + 1, k}, {i, j, k + 1}));
      if (k > 0) visit(triangle({i, j + 1, k}, {i + 1, j, k}, {i + 1, j + 1, k - 1}));
    }
}

}  // namespace

SurfaceMesh walls_with_nodes(const TetMesh& mesh) {
  const FaceNodes nodes(mesh);
  SurfaceMesh walls;
  PointsTaken taken(mesh.points);
  const auto add = [&](const std::vector<Triangle>& faces, const std::vector<std::uint32_t>& patch) {
    for (std::size_t f = 0; f < faces.size(); ++f)
      divide(nodes, faces[f], mesh.order(), [&](const Triangle& t) {
        walls.triangles.push_back(taken.take(t, walls.points));
        walls.patch.push_back(patch.empty() ? 0 : patch[f]);
      });
  };
  add(mesh.boundary, mesh.patch);
  add(mesh.interfaces, mesh.interface_patch);
  return walls;
}

}  // namespace octafront
