#include <octafront/mend.h>

#include "base/core/parallel.h"
#include "base/geometry/measures.h"
#include "pipeline/stages/stages.h"

#include <algorithm>

namespace octafront {

namespace {

void name_again(const ClosedPatch& closed, const TriangleTree& tree, const std::vector<Vec3>& points,
                const std::vector<Triangle>& triangles, std::vector<std::uint32_t>& patch,
                std::vector<std::string>& names) {
  if (closed.patch == kNone) return;
  patch.resize(triangles.size());
  parallel_for(triangles.size(), [&](std::size_t t) {
    const auto [a, b, c] = triangles[t];
    if (closed.is_in_it[tree.nearest(centroid(points[a], points[b], points[c])).triangle]) patch[t] = closed.patch;
  });
  const bool is_there = std::ranges::find(patch, closed.patch) != patch.end();
  if (!is_there && names.size() == closed.patch + 1) names.pop_back();
}

}  // namespace

ClosedPatch take_closed_patch(SurfaceMesh& surface, const EdgeTable& edges) {
  const auto name = std::ranges::find(surface.patch_names, kClosedByRepair);
  if (name == surface.patch_names.end()) return {};
  ClosedPatch closed{static_cast<std::uint32_t>(name - surface.patch_names.begin()), {}};
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    closed.is_in_it.push_back(surface.patch_of(t) == closed.patch);
  // From the rims inward, in the order of the edges.
  for (bool any = true; any;) {
    any = false;
    for (std::size_t e = 0; e < edges.size(); ++e)
      for (const HalfEdge g : edges.uses(e))
        for (const HalfEdge h : edges.uses(e)) {
          if (surface.patch[g / 3] != closed.patch || surface.patch[h / 3] == closed.patch) continue;
          surface.patch[g / 3] = surface.patch[h / 3];
          any = true;
        }
  }
  return closed;
}

void name_closed_patch(const ClosedPatch& closed, const TriangleTree& tree, SurfaceMesh& boundary) {
  name_again(closed, tree, boundary.points, boundary.triangles, boundary.patch, boundary.patch_names);
}

void name_closed_patch(const ClosedPatch& closed, const TriangleTree& tree, TetMesh& mesh) {
  name_again(closed, tree, mesh.points, mesh.boundary, mesh.patch, mesh.patch_names);
}

}  // namespace octafront
