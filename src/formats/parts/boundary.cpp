#include "formats/parts/boundary.h"

#include "base/mesh/adjacency.h"

namespace octafront::io {

std::vector<TetIndex> tets_of_faces(std::span<const Tet> tets, std::span<const Triangle> faces, std::size_t points) {
  const FaceTable table = face_table(points, faces);
  std::vector<TetIndex> tet_of(faces.size(), kNone);
  for (TetIndex t = 0; t < tets.size(); ++t)
    for (int i = 0; i < 4; ++i)
      for (const FaceTable::Entry& listed : table.group_of(face_of(tets[t], i)))
        if (tet_of[listed.face] == kNone) tet_of[listed.face] = t;
  return tet_of;
}

std::vector<Triangle> boundary_of(std::span<const Tet> tets, std::size_t points) {
  std::vector<Triangle> boundary;
  half_face_table(tets, points).for_each_group([&](const Triangle&, std::span<const FaceTable::Entry> on_face) {
    if (on_face.size() == 1) boundary.push_back(corners_of(tets, on_face[0].face));
  });
  return boundary;
}

}  // namespace octafront::io
