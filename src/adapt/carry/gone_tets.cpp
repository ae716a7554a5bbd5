#include "adapt/carry/carry.h"

namespace octafront::adapt {

Vec3 nearest_on(const TetCorners& corners, Vec3 p) {
  Vec3 best = p;
  double distance = HUGE_VAL;
  for (const auto& f : kTetFaces) {
    const auto corner = [&](std::size_t k) { return corners[static_cast<std::size_t>(f[k])]; };
    const Vec3 q = closest_point_on_triangle(p, corner(0), corner(1), corner(2));
    if (const double d = squared_distance(p, q); d < distance) distance = d, best = q;
  }
  return best;
}

GoneTets::GoneTets(const MeshPair& meshes)
    : mesh_(meshes.before), is_kept_(kept_of(meshes)), boxes_(items_of(mesh_, is_kept_)) {}

std::vector<std::uint8_t> GoneTets::kept_of(const MeshPair& meshes) {
  std::vector<std::uint8_t> is_kept(meshes.before.tets.size(), 0);
  for (const TetIndex t : meshes.same.old_tet_of_new)
    if (t != kNone) is_kept[t] = 1;
  return is_kept;
}

std::vector<GoneTets::Boxes::Item> GoneTets::items_of(const TetMesh& mesh, const std::vector<std::uint8_t>& is_kept) {
  std::vector<Boxes::Item> items;
  for (TetIndex t = 0; t < mesh.tets.size(); ++t) {
    if (is_kept[t]) continue;
    items.push_back({{}, t});
    for (const Vec3& p : corners_in(mesh, t)) items.back().bounds.add(p);
  }
  return items;
}

}  // namespace octafront::adapt
