#include "base/mesh/adjacency.h"

#include "base/core/index_range.h"

namespace octafront {

FaceTable half_face_table(std::span<const Tet> tets, std::size_t vertex_count) {
  require_in_range(tets.size(), kMostTetsWithHalfFaces, "tetrahedra with half-faces");
  return {vertex_count, [&](const auto& add) {
            const auto half_faces = static_cast<HalfFace>(4 * tets.size());
            for (HalfFace h = 0; h < half_faces; ++h) add(corners_of(tets, h), h);
          }};
}

std::vector<HalfFace> half_face_neighbors(std::span<const Tet> tets, std::size_t vertex_count) {
  const FaceTable table = half_face_table(tets, vertex_count);
  std::vector<HalfFace> across(4 * tets.size(), kNone);
  table.for_each_group([&](const Triangle&, std::span<const FaceTable::Entry> on_face) {
    if (on_face.size() != 2) return;
    across[on_face[0].face] = on_face[1].face;
    across[on_face[1].face] = on_face[0].face;
  });
  return across;
}

std::vector<Triangle> boundary_triangles(std::span<const Tet> tets, std::span<const HalfFace> across) {
  std::vector<Triangle> boundary;
  for (HalfFace h = 0; h < across.size(); ++h)
    if (across[h] == kNone) boundary.push_back(corners_of(tets, h));
  return boundary;
}

}  // namespace octafront
