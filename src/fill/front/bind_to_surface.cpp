#include "fill/front/bind_to_surface.h"

#include <octafront/surface_mesh.h>

#include "base/core/disjoint_sets.h"
#include "base/mesh/complex.h"
#include "base/shared/shared_tets.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace octafront {

namespace {

bool has_one_shell(const SurfaceMesh& surface) {
  DisjointSets sets(surface.points.size());
  for (const auto& [a, b, c] : surface.triangles) sets.join(a, b), sets.join(b, c);
  const VertexIndex first = sets.find(surface.triangles[0][0]);
  return std::all_of(surface.triangles.begin(), surface.triangles.end(),
                     [&](const Triangle& t) { return sets.find(t[0]) == first; });
}

/// Of the bodies, per tetrahedron; empty if there is only one, or if the surface names one region: its pieces are one.
std::vector<std::uint32_t> regions_of(const TetMesh& mesh, const SurfaceMesh& surface, const Comm& comm) {
  if (surface.region_names.size() == 1 || has_one_shell(surface)) return {};
  // What tetrahedra connect: a body's outer shell and its cavities.
  DisjointSets sets(mesh.points.size());
  for (const Tet& t : mesh.tets)
    for (int i = 1; i < 4; ++i) sets.join(t[0], t[i]);
  join_sets(sets, mesh.points.size(), comm);
  std::vector<std::uint32_t> number(mesh.points.size(), kNone), region;
  std::uint32_t bodies = 0;
  for (const Triangle& t : surface.triangles) {
    std::uint32_t& n = number[sets.find(t[0])];
    if (n == kNone) n = bodies++;
  }
  region.reserve(mesh.tets.size());
  for (const Tet& t : mesh.tets) region.push_back(number[sets.find(t[0])]);
  return region;
}

}  // namespace

void bind_to_surface(TetMesh& mesh, const SurfaceMesh& surface, const Comm& comm) {
  mesh.region = surface.sides.empty() ? regions_of(mesh, surface, comm) : regions_within(surface, mesh);
  mesh.region_names = surface.region_names;
  mesh.region_labels = surface.region_labels;
  list_faces(surface, mesh);
}

}  // namespace octafront
