#include "overlaps.h"

#include <octafront/repair.h>

#include "text.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

#include <fmt/core.h>

namespace octafront::cli {

namespace {

/// The boundary, with its own vertices only, as a complex of one region: its edges may have any number of faces.
RepairedSurface boundary_of(const TetMesh& mesh) {
  RepairedSurface boundary;
  std::vector<VertexIndex> number(mesh.points.size(), kNone);
  for (Triangle t : mesh.boundary) {
    for (VertexIndex& v : t) {
      if (number[v] == kNone) {
        number[v] = static_cast<VertexIndex>(boundary.surface.points.size());
        boundary.surface.points.push_back(mesh.points[v]);
      }
      v = number[v];
    }
    boundary.surface.triangles.push_back(t);
    boundary.surface.sides.push_back({kNone, 0});
  }
  return boundary;
}

/// Faces with their corners at the same places, but not at the same nodes: pairs of them, and where the first one is.
struct Doubled {
  std::uint64_t pairs = 0;
  Vec3 at;
};

Doubled doubled_faces(const SurfaceMesh& surface) {
  const auto key = [&](VertexIndex v) {
    const Vec3 p = surface.points[v] + Vec3{};  // -0 is 0
    return std::tuple(p.x, p.y, p.z);
  };
  std::map<std::tuple<double, double, double>, VertexIndex> first;
  std::vector<VertexIndex> place;
  for (VertexIndex v = 0; v < surface.points.size(); ++v) place.push_back(first.try_emplace(key(v), v).first->second);
  std::vector<Triangle> faces = surface.triangles;
  for (Triangle& t : faces) {
    for (VertexIndex& v : t) v = place[v];
    std::sort(t.begin(), t.end());
  }
  std::sort(faces.begin(), faces.end());
  Doubled doubled;
  for (std::size_t f = 1; f < faces.size(); ++f)
    if (faces[f] == faces[f - 1] && doubled.pairs++ == 0) doubled.at = surface.points[faces[f][0]];
  return doubled;
}

std::string place_in_words(Vec3 p) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x, p.y, p.z);
}

}  // namespace

std::optional<std::string> first_overlap(const TetMesh& mesh, const RunContext& context) {
  const RepairedSurface boundary = boundary_of(mesh);
  if (const Doubled doubled = doubled_faces(boundary.surface); doubled.pairs > 0)
    return fmt::format(
        "it is torn, or in two copies: {} of its boundary's faces {} at the same place with nodes of their own, the "
        "first near {}. Merge the nodes that are there twice",
        counted(doubled.pairs, "pair"), doubled.pairs == 1 ? "lies" : "lie", place_in_words(doubled.at));
  const SurfaceDefects found = find_defects(boundary, context);
  if (found.self_intersections.count > 0)
    return fmt::format("parts of it overlap: {} of its boundary's faces cross or touch, the first near {}",
                       counted(found.self_intersections.count, "pair"),
                       place_in_words(found.self_intersections.first.front().at));
  if (found.misplaced_parts.count > 0)
    return fmt::format("parts of it overlap: {} of its boundary {} inside of other elements, the first near {}",
                       counted(found.misplaced_parts.count, "part"), found.misplaced_parts.count == 1 ? "lies" : "lie",
                       place_in_words(found.misplaced_parts.first.front().at));
  return std::nullopt;
}

}  // namespace octafront::cli
