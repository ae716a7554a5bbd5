#include "overlaps.h"

#include <octafront/repair.h>
#include <octafront/split.h>

#include "text.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include <fmt/core.h>

namespace octafront::cli {

namespace {

/// Per patch whether it is one of the two sides of what split_patches() or split_contacts() opened.
std::vector<char> sides_of(const TetMesh& mesh) {
  const std::set<std::string> names(mesh.patch_names.begin(), mesh.patch_names.end());
  std::vector<char> sides;
  for (const std::string& name : mesh.patch_names)
    sides.push_back(std::ranges::any_of(other_sides(name), [&](const auto& other) { return names.contains(other); }));
  sides.resize(std::max<std::size_t>(1, sides.size()), 0);
  return sides;
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
    const std::vector<char> sides = sides_of(mesh);
    for (std::size_t f = 0; f < gone_.size(); ++f) {
      if (const std::uint32_t p = mesh.patch.empty() ? 0 : mesh.patch[f]; p >= sides.size() || !sides[p]) continue;
      Triangle place = mesh.boundary[f];
      for (VertexIndex& v : place) v = first.try_emplace(place_of(mesh.points[v]), v).first->second;
      std::sort(place.begin(), place.end());
      at[place].push_back(f);
    }
    for (const auto& [place, faces] : at) {
      has_open_sides_ = has_open_sides_ || faces.size() != 2;
      if (faces.size() != 2) continue;
      for (const std::size_t f : faces) {
        gone_[f] = 1;
        for (const VertexIndex v : mesh.boundary[f]) to_[v] = first.at(place_of(mesh.points[v]));
      }
    }
  }
  bool is_gone(std::size_t face) const { return gone_[face]; }
  /// Whether sides of contacts have triangles of their own, which cross where they are curved.
  bool has_open_sides() const { return has_open_sides_; }
  VertexIndex operator()(VertexIndex v) const { return to_[v]; }

 private:
  std::vector<VertexIndex> to_;
  std::vector<char> gone_;
  bool has_open_sides_ = false;
};

/// The faces of the boundary, without those that are gone; where sides are open, of each part that hangs together.
std::vector<std::vector<std::size_t>> parts_of(const TetMesh& mesh, const Closed& closed) {
  std::vector<VertexIndex> first(mesh.points.size(), 0);  // a node of the part, lower ones first
  const auto find = [&](VertexIndex v) {
    while (first[v] != v) v = first[v] = first[first[v]];
    return v;
  };
  if (closed.has_open_sides()) {
    for (VertexIndex v = 0; v < first.size(); ++v) first[v] = v;
    for (const Tet& tet : mesh.tets)
      for (const VertexIndex v : tet) {
        const auto [low, high] = std::minmax({find(closed(tet[0])), find(closed(v))});
        first[high] = low;
      }
  }
  std::map<VertexIndex, std::vector<std::size_t>> parts;
  for (std::size_t f = 0; f < mesh.boundary.size(); ++f)
    if (!closed.is_gone(f)) parts[find(closed(mesh.boundary[f][0]))].push_back(f);
  std::vector<std::vector<std::size_t>> list;
  for (auto& [node, faces] : parts) list.push_back(std::move(faces));
  return list;
}

/// These faces of the boundary, with their own vertices only, as a complex of one region: its edges may have any number
/// of faces.
RepairedSurface boundary_of(const TetMesh& mesh, const Closed& closed, const std::vector<std::size_t>& faces) {
  RepairedSurface boundary;
  std::map<VertexIndex, VertexIndex> number;
  for (const std::size_t f : faces) {
    Triangle t = mesh.boundary[f];
    for (VertexIndex& v : t) {
      const auto [at, is_new] = number.try_emplace(closed(v), static_cast<VertexIndex>(number.size()));
      if (is_new) boundary.surface.points.push_back(mesh.points[at->first]);
      v = at->second;
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

std::optional<std::string> overlap_of(const RepairedSurface& boundary, const RunContext& context) {
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

}  // namespace

std::optional<std::string> first_overlap(const TetMesh& mesh, const RunContext& context) {
  const Closed closed(mesh);
  for (const std::vector<std::size_t>& faces : parts_of(mesh, closed))
    if (auto found = overlap_of(boundary_of(mesh, closed, faces), context)) return found;
  return std::nullopt;
}

}  // namespace octafront::cli
