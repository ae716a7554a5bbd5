#include "base/core/parallel.h"
#include "base/mesh/complex_patches.h"
#include "pipeline/stages/stages.h"

#include <algorithm>

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

void follow_boundary(const TetMesh& mesh, SurfaceMesh& filled) {
  const std::vector<Sides> sides_of_patch = sides_of_patches(filled);
  filled.triangles = mesh.boundary;
  filled.triangles.insert(filled.triangles.end(), mesh.interfaces.begin(), mesh.interfaces.end());
  filled.patch = mesh.patch;
  filled.patch.insert(filled.patch.end(), mesh.interface_patch.begin(), mesh.interface_patch.end());
  VertexIndex last = 0;
  for (const Triangle& t : filled.triangles) last = std::max({last, t[0], t[1], t[2]});
  filled.points.assign(mesh.points.begin(), mesh.points.begin() + last + 1);
  if (filled.sides.empty()) return;
  filled.sides.clear();
  for (const std::uint32_t patch : filled.patch) filled.sides.push_back(sides_of_patch[patch]);
}

}  // namespace octafront
