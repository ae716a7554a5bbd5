#include <octafront/generate.h>
#include <octafront/named_groups.h>

#include "base/core/flat_map.h"
#include "base/core/renumber.h"
#include "base/mesh/adjacency.h"
#include "base/mesh/complex_patches.h"
#include "base/mesh/face_table.h"
#include "pipeline/stages/moving.h"

#include <algorithm>
#include <utility>

namespace octafront {
namespace {

std::uint32_t region_at(const TetMesh& mesh, TetIndex t) {
  return mesh.region.empty() ? 0 : mesh.region[t];
}

/// The boundary, the interfaces, and what else lies between regions, with their patches.
struct PatchedWalls {
  std::vector<Triangle> faces;
  std::vector<std::uint32_t> patch;
};

PatchedWalls patched_walls(const TetMesh& mesh) {
  PatchedWalls walls;
  FlatSet<Triangle> known;
  const auto add = [&](const std::vector<Triangle>& faces, const std::vector<std::uint32_t>& patch) {
    walls.faces.insert(walls.faces.end(), faces.begin(), faces.end());
    for (std::size_t f = 0; f < faces.size(); ++f) walls.patch.push_back(patch.empty() ? 0 : patch[f]);
    for (const Triangle& face : faces) known.insert(face_key(face));
  };
  add(mesh.boundary, mesh.patch), add(mesh.interfaces, mesh.interface_patch);
  const std::uint32_t unnamed = 1 + *std::max_element(walls.patch.begin(), walls.patch.end());
  const std::vector<HalfFace> across = half_face_neighbors(mesh.tets, mesh.points.size());
  for (HalfFace h = 0; h < across.size(); ++h) {
    if (across[h] == kNone || across[h] < h || region_at(mesh, h / 4) == region_at(mesh, across[h] / 4)) continue;
    const Triangle face = corners_of(mesh.tets, h);
    if (!known.contains(face_key(face))) walls.faces.push_back(face), walls.patch.push_back(unnamed);
  }
  return walls;
}

std::vector<Sides> sides_of(const std::vector<Triangle>& walls, const TetMesh& mesh) {
  FlatMap<Triangle, std::uint32_t> wall_at(walls.size());
  for (std::uint32_t f = 0; f < walls.size(); ++f) wall_at.find_or_add(face_key(walls[f]), f);
  std::vector<Sides> sides(walls.size(), {kNone, kNone});
  for (TetIndex t = 0; t < mesh.tets.size(); ++t)
    for (int i = 0; i < 4; ++i) {
      const Triangle face = face_of(mesh.tets[t], i);
      const std::uint32_t* wall = wall_at.find(face_key(face));
      if (wall == nullptr) continue;
      auto& [front, behind] = sides[*wall];
      (is_even(face) == is_even(walls[*wall]) ? behind : front) = region_at(mesh, t);
    }
  return sides;
}

}  // namespace

Domain domain_of(const TetMesh& mesh) {
  auto [faces, patch] = patched_walls(mesh);
  SurfaceMesh walls;
  walls.sides = sides_of(faces, mesh);
  PointsTaken taken(mesh.points);
  for (const Triangle& face : faces) walls.triangles.push_back(taken.take(face, walls.points));
  walls.patch = std::move(patch);
  walls.patch_names = mesh.patch_names, walls.region_names = mesh.region_names;
  walls.patch_labels = mesh.patch_labels, walls.region_labels = mesh.region_labels;
  Domain domain(std::move(walls));
  domain.sets = placed_sets(mesh);
  return domain;
}

TetMesh meshed_anew(const TetMesh& mesh, const Options& options, const RunContext& context) {
  Domain domain = domain_of(mesh);
  const std::vector<std::uint32_t> before = domain.surface.patch;
  divide_by_sides(domain.surface);
  std::vector<std::uint32_t> patch_of(domain.surface.patch_names.size(), 0);
  for (std::size_t t = 0; t < before.size(); ++t) patch_of[domain.surface.patch[t]] = before[t];
  std::vector<std::string> names = mesh.patch_names;
  names.resize(std::max<std::size_t>(names.size(), 1 + *std::max_element(before.begin(), before.end())));
  for (std::size_t p = 0; p < patch_of.size(); ++p)
    if (patch_of[p] >= mesh.patch_names.size()) names[patch_of[p]] = domain.surface.patch_names[p];
  TetMesh made = generate(domain, options, context).mesh;
  for (std::vector<std::uint32_t>* patches : {&made.patch, &made.interface_patch})
    for (std::uint32_t& patch : *patches) patch = patch_of[patch];
  made.patch_names = std::move(names), made.patch_labels = mesh.patch_labels;
  return made;
}

}  // namespace octafront
