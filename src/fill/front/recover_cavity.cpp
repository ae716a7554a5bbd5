#include "fill/front/recover_cavity.h"

#include <octafront/error.h>

#include "base/mesh/complex.h"
#include "fill/recovery/recover.h"

#include <set>

namespace octafront {

SurfaceMesh surface_of(const WorkMesh& mesh, const std::vector<Wall>& walls, std::vector<VertexIndex>& global) {
  SurfaceMesh surface;
  FlatMap<VertexIndex, VertexIndex> local(walls.size());
  std::set<WallKey> keys;
  for (const Wall& w : walls) keys.insert(wall_key(w));
  for (const Wall& w : walls) {
    const bool two_sided = keys.contains(back_of(wall_key(w)));
    if (two_sided && is_even(w)) continue;  // its back stands for both
    surface.sides.push_back({two_sided ? 0 : kNone, 0});
    Triangle outward{w[0], w[2], w[1]};
    for (VertexIndex& v : outward) {
      const VertexIndex number = local.find_or_add(v, static_cast<VertexIndex>(global.size()));
      if (number == global.size()) {
        surface.points.push_back(mesh.at(v));
        global.push_back(v);
      }
      v = number;
    }
    surface.triangles.push_back(outward);
  }
  if (!is_complex(surface)) surface.sides.clear();
  return surface;
}

bool close_by_recovery(const OpenCavity& cavity, int rings, const RunContext& context) {
  WorkMesh& mesh = cavity.mesh;
  Excavation excavation(cavity);
  for (int ring = 0; ring < rings; ++ring)
    if (!excavation.grow_ring()) return false;
  std::vector<VertexIndex> global;
  const SurfaceMesh surface = surface_of(mesh, excavation.walls(), global);
  TetMesh filling;
  try {
    StageReport unused;
    filling = recover_volume(surface, {context, unused}, RecoveryPatience::kCavity);
  } catch (const MeshingError&) {
    return false;  // the next rung, a larger cavity, gives other walls
  }
  for (std::size_t v = global.size(); v < filling.points.size(); ++v)
    global.push_back(mesh.add_point(filling.points[v]));
  for (const Tet& t : filling.tets) mesh.add({global[t[0]], global[t[1]], global[t[2]], global[t[3]]});
  excavation.commit();
  return true;
}

}  // namespace octafront
