#include "soup/periods/rebuilt.h"

#include <octafront/mend.h>

#include "base/core/renumber.h"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/core.h>

namespace octafront::periods {

namespace {

/// A triangle with vertices on its edges: on[i] from corner i to the next one.
struct Divided {
  Triangle t;
  std::array<std::vector<VertexIndex>, 3> on;
};

/// Two triangles on either side of the middle vertex of an edge, and so on.
void halve(const Divided& d, const FaceKind& kind, Rebuilt& to) {
  int i = 0;
  while (i < 3 && d.on[i].empty()) ++i;
  if (i == 3) return to.add(d.t, kind);
  const std::vector<VertexIndex>& on = d.on[i];
  const auto middle = on.begin() + static_cast<std::ptrdiff_t>(on.size() / 2);
  const int j = (i + 1) % 3, k = (i + 2) % 3;
  halve({{d.t[i], *middle, d.t[k]}, {std::vector(on.begin(), middle), {}, d.on[k]}}, kind, to);
  halve({{*middle, d.t[j], d.t[k]}, {std::vector(middle + 1, on.end()), d.on[j], {}}}, kind, to);
}

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
  std::vector<std::string> names;
  for (std::size_t p = 0; p < number.size(); ++p) {
    if (number[p] == kNone) continue;
    number[p] = static_cast<std::uint32_t>(names.size());
    names.push_back(std::move(surface.patch_names[p]));
  }
  for (std::uint32_t& p : surface.patch) p = number[p];
  surface.patch_names = std::move(names);
  surface.patch_labels.clear();
}

}  // namespace

void fill_in(SurfaceMesh& surface) {
  if (surface.patch.empty()) surface.patch.assign(surface.triangles.size(), 0);
  if (surface.sides.empty()) surface.sides.assign(surface.triangles.size(), {kNone, 0});
}

void add_divided(const Triangle& t, const FaceKind& kind, const std::map<Edge, std::vector<VertexIndex>>& between,
                 Rebuilt& to) {
  Divided divided{t, {}};
  for (int i = 0; i < 3; ++i) {
    const VertexIndex a = t[i], b = t[(i + 1) % 3];
    const auto at = between.find({std::min(a, b), std::max(a, b)});
    if (at == between.end()) continue;
    divided.on[i] = at->second;
    if (a > b) std::reverse(divided.on[i].begin(), divided.on[i].end());
  }
  halve(divided, kind, to);
}

void take(Rebuilt rebuilt, SurfaceMesh& surface) {
  surface.triangles = std::move(rebuilt.triangles);
  surface.patch.clear(), surface.sides.clear();
  for (const FaceKind& kind : rebuilt.kinds) surface.patch.push_back(kind.patch), surface.sides.push_back(kind.sides);
  drop_unused_points(surface.points, surface.triangles);
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

MadePeriodic made_of(SurfaceMesh& surface, const std::function<MadePeriodic()>& make) {
  std::vector<std::uint32_t> source(surface.triangles.size());
  for (std::uint32_t t = 0; t < source.size(); ++t) source[t] = surface.source_of(t);
  const bool is_plain = surface.sides.empty();
  MadePeriodic made = make();
  if (is_plain) surface.sides.clear();
  surface.source.clear();
  for (const std::uint32_t t : made.origin) surface.source.push_back(source[t]);
  return made;
}

}  // namespace octafront::periods
