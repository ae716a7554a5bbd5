#include "pipeline/follow_boundary.h"

#include "core/parallel.h"

namespace octafront {
namespace {

/// How far the input is looked for at first, in edge lengths: a short search for nearly all.
constexpr double kFirstLook = 0.1;

}  // namespace

void renew_sources(TetMesh& mesh, const SurfaceMesh& before, const SurfaceMesh& input, const TriangleTree& tree) {
  if (mesh.source.empty()) return;
  parallel_for(mesh.boundary.size(), [&](std::size_t t) {
    const auto& [a, b, c] = mesh.boundary[t];
    const auto& [x, y, z] = before.triangles[t];
    if (mesh.points[a] == before.points[x] && mesh.points[b] == before.points[y] && mesh.points[c] == before.points[z])
      return;
    const Vec3 middle = (mesh.points[a] + mesh.points[b] + mesh.points[c]) / 3;
    auto below = tree.nearest(middle, kFirstLook * kFirstLook * squared_length(mesh.points[b] - mesh.points[a]));
    if (below.triangle == kNone) below = tree.nearest(middle);
    mesh.source[t] = input.source_of(below.triangle);
  });
}

}  // namespace octafront
