#include "volume/regions.h"

#include <algorithm>
#include <numeric>

namespace octafront {

namespace {

/// Joins what tetrahedra connect: a body's outer shell and its cavities.
class VertexSets {
 public:
  explicit VertexSets(std::size_t vertices) : parent_(vertices) { std::iota(parent_.begin(), parent_.end(), 0u); }
  VertexIndex root(VertexIndex v) {
    while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
    return v;
  }
  void join(VertexIndex a, VertexIndex b) {
    a = root(a), b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<VertexIndex> parent_;
};

bool has_one_shell(const SurfaceMesh& surface) {
  VertexSets sets(surface.points.size());
  for (const auto& [a, b, c] : surface.triangles) sets.join(a, b), sets.join(b, c);
  const VertexIndex first = sets.root(surface.triangles[0][0]);
  return std::all_of(surface.triangles.begin(), surface.triangles.end(),
                     [&](const Triangle& t) { return sets.root(t[0]) == first; });
}

}  // namespace

std::vector<std::uint32_t> regions_of(const TetMesh& mesh, const SurfaceMesh& surface) {
  if (has_one_shell(surface)) return {};
  VertexSets sets(mesh.points.size());
  for (const Tet& t : mesh.tets)
    for (int i = 1; i < 4; ++i) sets.join(t[0], t[i]);
  std::vector<std::uint32_t> number(mesh.points.size(), kNone), region;
  std::uint32_t bodies = 0;
  for (const Triangle& t : surface.triangles) {
    std::uint32_t& n = number[sets.root(t[0])];
    if (n == kNone) n = bodies++;
  }
  region.reserve(mesh.tets.size());
  for (const Tet& t : mesh.tets) region.push_back(number[sets.root(t[0])]);
  return region;
}

void bind_to_surface(TetMesh& mesh, const SurfaceMesh& surface) {
  mesh.region = regions_of(mesh, surface);
  mesh.boundary = surface.triangles;
  mesh.patch = surface.patch;
  mesh.patch_names = surface.patch_names;
}

}  // namespace octafront
