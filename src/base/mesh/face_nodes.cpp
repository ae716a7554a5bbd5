#include "base/mesh/face_nodes.h"

#include "base/geometry/tet_lattice.h"
#include "base/mesh/face_table.h"

#include <algorithm>

namespace octafront {

FaceNodes::FaceNodes(const TetMesh& mesh)
    : mesh_(mesh), faces_(faces_of_tets(mesh.tets, mesh.points.size())), side_(faces_.corners.size(), kNone) {
  for (TetIndex t = 0; t < mesh.tets.size(); ++t)
    for (const std::uint32_t f : faces_.of_tet[t]) side_[f] = t;
}

bool FaceNodes::has(const Triangle& face) const {
  return std::ranges::binary_search(faces_.corners, face_key(face));
}

VertexIndex FaceNodes::node(const Triangle& face, const Weights& weights) const {
  const auto f = std::ranges::lower_bound(faces_.corners, face_key(face)) - faces_.corners.begin();
  const TetIndex t = side_[static_cast<std::size_t>(f)];
  const Tet& tet = mesh_.tets[t];
  TetLattice::Weights w{};
  for (std::size_t i = 0; i < 3; ++i)
    w[static_cast<std::size_t>(std::ranges::find(tet, face[i]) - tet.begin())] = static_cast<std::int8_t>(weights[i]);
  const std::size_t n = tet_lattice(mesh_.order()).at(w);
  if (n < 4) return tet[n];
  return mesh_.is_second_order() ? mesh_.mid_nodes[t][n - 4] : mesh_.high_nodes[t * mesh_.high_nodes_per_tet() + n - 4];
}

}  // namespace octafront
