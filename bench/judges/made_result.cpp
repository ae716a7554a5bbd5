#include "made_result.h"

#include "base/core/disjoint_sets.h"

#include <array>
#include <map>
#include <vector>

namespace octafront {

namespace {

Triangle sorted(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

std::vector<Triangle> single_faces(const TetMesh& mesh, std::uint32_t& components) {
  std::vector<std::pair<Triangle, std::uint32_t>> faces;  // sorted corners, 4 * tet + face
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t)
    for (std::uint32_t f = 0; f < 4; ++f) {
      Triangle key;
      for (int k = 0; k < 3; ++k) key[k] = mesh.tets[t][kTetFaces[f][k]];
      std::sort(key.begin(), key.end());
      faces.push_back({key, 4 * t + f});
    }
  std::sort(faces.begin(), faces.end());
  DisjointSets sets(mesh.tets.size());
  std::vector<Triangle> single;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (i + 1 < faces.size() && faces[i].first == faces[i + 1].first) {
      sets.join(faces[i].second / 4, faces[i + 1].second / 4);
      ++i;
      continue;
    }
    const Tet& tet = mesh.tets[faces[i].second / 4];
    const auto& f = kTetFaces[faces[i].second % 4];
    single.push_back({tet[f[0]], tet[f[1]], tet[f[2]]});
  }
  components = 0;
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) components += sets.find(t) == t;
  return single;
}

/// Counts of a surface: shells, genus, edges without just two triangles that agree, vertices with more than one fan.
Json kind_of(const SurfaceMesh& s) {
  std::map<Edge, std::array<int, 2>> edges;
  DisjointSets shells(s.points.size()), fans(3 * s.triangles.size());
  std::map<Edge, std::uint32_t> half;
  for (std::uint32_t t = 0; t < s.triangles.size(); ++t)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const VertexIndex a = s.triangles[t][k], b = s.triangles[t][(k + 1) % 3];
      ++edges[{std::min(a, b), std::max(a, b)}][a < b];
      shells.join(a, b);
      half[{a, b}] = 3 * t + k;
    }
  std::size_t bad_edges = 0, used = 0, roots = 0, fan_count = 0;
  for (const auto& [e, n] : edges) bad_edges += n[0] != 1 || n[1] != 1;
  // Corners at one vertex belong to one fan if their triangles share an edge there.
  for (const auto& [e, h] : half) {
    const auto other = half.find({e[1], e[0]});
    if (other == half.end()) continue;
    const auto next = [](std::uint32_t c) { return c / 3 * 3 + (c + 1) % 3; };
    fans.join(h, next(other->second));
    fans.join(next(h), other->second);
  }
  for (std::uint32_t c = 0; c < 3 * s.triangles.size(); ++c) fan_count += fans.find(c) == c;
  std::vector<bool> is_used(s.points.size());
  for (const Triangle& t : s.triangles)
    for (const VertexIndex v : t) is_used[v] = true;
  for (VertexIndex v = 0; v < s.points.size(); ++v) {
    used += is_used[v];
    roots += is_used[v] && shells.find(v) == v;
  }
  const auto euler =
      static_cast<long>(fan_count) - static_cast<long>(edges.size()) + static_cast<long>(s.triangles.size());
  return {{"triangles", s.triangles.size()},
          {"shells", roots},
          {"genus", static_cast<long>(roots) - euler / 2},
          {"bad_edges", bad_edges},
          {"bad_vertices", static_cast<long>(fan_count) - static_cast<long>(used)}};
}

/// Solids of a closed surface: shells that face outward.
std::uint32_t outward_shells(const SurfaceMesh& s) {
  DisjointSets sets(s.points.size());
  for (const Triangle& t : s.triangles) sets.join(t[0], t[1]), sets.join(t[1], t[2]);
  std::map<std::uint32_t, double> volumes;
  for (const Triangle& t : s.triangles)
    volumes[sets.find(t[0])] += six_volumes(s.points[0], s.points[t[0]], s.points[t[1]], s.points[t[2]]);
  return static_cast<std::uint32_t>(
      std::count_if(volumes.begin(), volumes.end(), [](const auto& v) { return v.second > 0; }));
}

SurfaceMesh boundary_of(const TetMesh& mesh, std::uint32_t& components) {
  SurfaceMesh boundary;
  boundary.points = mesh.points;
  boundary.triangles = single_faces(mesh, components);
  if (mesh.patch.empty()) return boundary;
  std::map<Triangle, std::uint32_t> patches;
  for (std::size_t i = 0; i < mesh.boundary.size(); ++i) patches[sorted(mesh.boundary[i])] = mesh.patch[i];
  for (const Triangle& t : boundary.triangles) boundary.patch.push_back(patches[sorted(t)]);
  boundary.patch_names = mesh.patch_names;
  return boundary;
}

Json about(const TetMesh& mesh) {
  const auto defect = first_defect(mesh);
  const QualitySummary q = summarize_quality(mesh);
  std::uint32_t regions = 1;
  for (const std::uint32_t r : mesh.region) regions = std::max(regions, r + 1);
  return {{"tets", mesh.tets.size()},
          {"defect", defect ? Json(*defect) : Json(nullptr)},
          {"regions", regions},
          {"beta_mean", q.beta_mean},
          {"dihedral_min", q.dihedral_min},
          {"dihedral_max", q.dihedral_max}};
}

}  // namespace

MadeResult read_result(const std::string& file) {
  MadeResult made;
  std::uint32_t components = 0;
  if (file.ends_with(".off") || file.ends_with(".obj")) {
    made.boundary = read_surface(file).surface;
    components = outward_shells(made.boundary);
  } else {
    const TetMesh mesh = read_mesh(file);
    made.boundary = boundary_of(mesh, components);
    made.about = about(mesh);
  }
  made.about["components"] = components;
  made.about.update(kind_of(made.boundary));
  return made;
}

}  // namespace octafront
