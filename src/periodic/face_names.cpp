#include "periodic/face_names.h"

#include <octafront/mend.h>

#include "base/core/renumber.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include <fmt/core.h>

namespace octafront {

namespace {

std::vector<std::uint8_t> patches_on_one_face(const SurfaceMesh& surface, const std::vector<CellFace>& faces) {
  std::vector<CellFace> face(surface.patch_names.size(), kNone);
  std::vector<std::uint8_t> on_one(face.size(), 1);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const std::uint32_t p = surface.patch[t];
    if (faces[t] == kNone || (face[p] != kNone && face[p] != faces[t])) on_one[p] = 0;
    face[p] = faces[t];
  }
  return on_one;
}

void drop_unused_patches(SurfaceMesh& surface) {
  std::vector<std::uint32_t> number(surface.patch_names.size(), kNone);
  for (const std::uint32_t p : surface.patch) number[p] = 0;
  keep_numbered(surface.patch_names, number);
  for (std::uint32_t& p : surface.patch) p = number[p];
  surface.patch_labels.clear();
}

/// The names that make_periodic() gives to one face: "x_min", "x_min_2", ...
bool is_own_name(const std::string& name, const PeriodicCell& cell, CellFace face) {
  const std::string own = name_of_face(cell, face);
  return name == own ||
         (name.starts_with(own + "_") && name.find_first_not_of("0123456789", own.size() + 1) == std::string::npos);
}

}  // namespace

std::string name_of_face(const PeriodicCell& cell, CellFace face) {
  if (cell.is_box()) return fmt::format("{}_{}", kAxisNames[face / 2], face % 2 == 0 ? "min" : "max");
  return fmt::format("periodic_{}_{}", face / 2 + 1, face % 2 == 0 ? "low" : "high");
}

void name_faces(SurfaceMesh& s, const PeriodicCell& cell) {
  s.patch_names.resize(*std::max_element(s.patch.begin(), s.patch.end()) + 1);
  const PeriodicFaces faces = find_periodic_faces(s, cell);
  const std::vector<std::uint8_t> lies_on_one = patches_on_one_face(s, faces.face);
  std::map<std::array<std::uint32_t, 7>, std::uint32_t> number;
  std::map<std::string, int> names;
  std::vector<std::uint32_t> patch = s.patch;
  std::vector<std::string> added;
  const auto key_of = [&](std::uint32_t t) {
    const std::uint32_t u = faces.other[t];
    return std::array{faces.face[t], s.patch[t],    s.sides[t][0], s.sides[t][1],
                      s.patch[u],    s.sides[u][0], s.sides[u][1]};
  };
  const auto first_new = static_cast<std::uint32_t>(s.patch_names.size());
  for (std::uint32_t t = 0; t < s.triangles.size(); ++t) {
    if (faces.face[t] == kNone) continue;
    const auto [at, is_new] = number.try_emplace(key_of(t), first_new + static_cast<std::uint32_t>(added.size()));
    if (is_new) {
      const std::string& given = s.patch_names[s.patch[t]];
      added.push_back(lies_on_one[s.patch[t]] && !given.empty() && given != kClosedByRepair
                          ? given
                          : name_of_face(cell, faces.face[t]));
    }
    patch[t] = at->second;
  }
  for (std::string& name : added)
    if (const int n = ++names[name]; n > 1) name += fmt::format("_{}", n);
  s.patch = std::move(patch);
  s.patch_names.insert(s.patch_names.end(), added.begin(), added.end());
  drop_unused_patches(s);
}

void unite_patches(const PeriodicCell& cell, TetMesh& mesh) {
  std::vector<std::uint32_t> becomes(mesh.patch_names.size());
  for (std::uint32_t p = 0; p < becomes.size(); ++p) becomes[p] = p;
  for (const int k : cell.periods_there())
    for (CellFace face = 2 * static_cast<CellFace>(k), end = face + 2; face < end; ++face) {
      std::uint32_t first = kNone;
      for (std::uint32_t p = 0; p < becomes.size(); ++p)
        if (is_own_name(mesh.patch_names[p], cell, face)) becomes[p] = first = std::min(first, p);
      if (first != kNone) mesh.patch_names[first] = name_of_face(cell, face);
    }
  std::vector<std::uint32_t> number(becomes.size(), kNone);
  for (const std::uint32_t p : becomes) number[p] = 0;
  keep_numbered(mesh.patch_names, number);
  for (auto* patches : {&mesh.patch, &mesh.interface_patch})
    for (std::uint32_t& p : *patches) p = number[becomes[p]];
  mesh.patch_labels.clear();
}

}  // namespace octafront
