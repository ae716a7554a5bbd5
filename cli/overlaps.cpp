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

/// Whether a face lies on one of the two sides of what split_patches() opened.
bool is_side(const TetMesh& mesh, std::size_t face) {
  const std::uint32_t p = mesh.patch.empty() ? 0 : mesh.patch[face];
  if (p >= mesh.patch_names.size()) return false;
  return mesh.patch_names[p].ends_with("_plus") || mesh.patch_names[p].ends_with("_minus");
}

std::tuple<double, double, double> place_of(Vec3 p) {
  p += Vec3{};  // -0 is 0
  return {p.x, p.y, p.z};
}

/// A mesh is closed again where it was split: both sides go where they lie on each other, and their nodes are one.
class Closed {
 public:
  explicit Closed(const TetMesh& mesh) : to_(mesh.points.size()), gone_(mesh.boundary.size(), 0) {
    for (VertexIndex v = 0; v < to_.size(); ++v) to_[v] = v;
    std::map<std::tuple<double, double, double>, VertexIndex> first;
    std::map<Triangle, std::vector<std::size_t>> at;
    for (std::size_t f = 0; f < gone_.size(); ++f) {
      if (!is_side(mesh, f)) continue;
      Triangle place = mesh.boundary[f];
      for (VertexIndex& v : place) v = to_[v] = first.try_emplace(place_of(mesh.points[v]), v).first->second;
      std::sort(place.begin(), place.end());
      at[place].push_back(f);
    }
    for (const auto& [place, faces] : at)
      if (faces.size() == 2)
        for (const std::size_t f : faces) gone_[f] = 1;
  }
  bool is_gone(std::size_t face) const { return gone_[face]; }
  VertexIndex operator()(VertexIndex v) const { return to_[v]; }

 private:
  std::vector<VertexIndex> to_;
  std::vector<char> gone_;
};

/// The boundary, with its own vertices only, as a complex of one region: its edges may have any number of faces.
RepairedSurface boundary_of(const TetMesh& mesh) {
  RepairedSurface boundary;
  const Closed closed(mesh);
  std::vector<VertexIndex> number(mesh.points.size(), kNone);
  for (std::size_t f = 0; f < mesh.boundary.size(); ++f) {
    if (closed.is_gone(f)) continue;
    Triangle t = mesh.boundary[f];
    for (VertexIndex& v : t) {
      v = closed(v);
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
  std::map<std::tuple<double, double, double>, VertexIndex> first;
  std::vector<VertexIndex> place;
  for (VertexIndex v = 0; v < surface.points.size(); ++v)
    place.push_back(first.try_emplace(place_of(surface.points[v]), v).first->second);
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
