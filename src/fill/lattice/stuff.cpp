#include "fill/lattice/stuff.h"

#include <octafront/error.h>

#include "base/core/disjoint_sets.h"
#include "base/core/renumber.h"
#include "base/geometry/measures.h"
#include "fill/lattice/cut_lattice.h"
#include "fill/lattice/manifold.h"
#include "fill/lattice/snap_features.h"
#include "fill/lattice/stuffing_octree.h"

#include <algorithm>

namespace octafront {

namespace {

/// Connected parts of the mesh, numbered in order of their first tetrahedron; empty if there is only one.
std::vector<std::uint32_t> connected_parts(const TetMesh& mesh) {
  DisjointSets sets(mesh.points.size());
  for (const Tet& t : mesh.tets)
    for (int k = 1; k < 4; ++k) sets.join(t[0], t[k]);
  std::vector<std::uint32_t> number(mesh.points.size(), kNone), region;
  std::uint32_t parts = 0;
  region.reserve(mesh.tets.size());
  for (const Tet& t : mesh.tets) {
    std::uint32_t& n = number[sets.find(t[0])];
    if (n == kNone) n = parts++;
    region.push_back(n);
  }
  return parts > 1 ? region : std::vector<std::uint32_t>{};
}

/// Numbers the vertices of the boundary first, in the order of their numbers so far.
void put_boundary_first(TetMesh& mesh) {
  std::vector<char> on_boundary(mesh.points.size(), 0);
  for (const Triangle& t : mesh.boundary)
    for (const VertexIndex v : t) on_boundary[v] = 1;
  std::vector<VertexIndex> number(mesh.points.size());
  std::vector<Vec3> points;
  points.reserve(mesh.points.size());
  for (const char wanted : {1, 0})
    for (std::size_t v = 0; v < number.size(); ++v)
      if (on_boundary[v] == wanted) {
        number[v] = static_cast<VertexIndex>(points.size());
        points.push_back(mesh.points[v]);
      }
  mesh.points = std::move(points);
  renumber(mesh.tets, number);
  renumber(mesh.boundary, number);
}

void name_boundary(TetMesh& mesh, const SurfaceMesh& surface, const TriangleTree& triangles) {
  mesh.source.reserve(mesh.boundary.size());
  for (const auto& [a, b, c] : mesh.boundary)
    mesh.source.push_back(triangles.nearest(centroid(mesh.points[a], mesh.points[b], mesh.points[c])).triangle);
  if (surface.patch.empty()) return;
  for (const std::uint32_t triangle : mesh.source) mesh.patch.push_back(surface.patch[triangle]);
}

}  // namespace

TetMesh stuff_surface(const SurfaceMesh& surface, const Features& features, SurfaceDomain::Defects defects,
                      const SizeField& sizes, const Stage& stage) {
  const SurfaceDomain domain(surface, defects);
  const LatticeOctree octree = build_stuffing_octree(surface, domain, sizes, stage.context());
  stage.count("leaves", static_cast<double>(octree.tree.size()));
  TetMesh mesh = cut_lattice(octree.root, octree.tree, domain, stage);
  stage.count("tetrahedra dropped where parts touched",
              static_cast<double>(make_boundary_manifold(mesh, stage.context())));
  if (mesh.tets.empty())
    throw MeshingError("nothing inside the surface is as large as an element: choose a smaller element size");
  put_boundary_first(mesh);
  snap_features(mesh, surface, features, domain.triangles(), sizes, stage);
  name_boundary(mesh, surface, domain.triangles());
  mesh.region = connected_parts(mesh);
  mesh.patch_names = surface.patch_names;
  mesh.patch_labels = surface.patch_labels;
  stage.count("parts", mesh.region.empty() ? 1 : 1 + *std::max_element(mesh.region.begin(), mesh.region.end()));
  return mesh;
}

}  // namespace octafront
