#include "base/core/parallel.h"
#include "base/mesh/edge_table.h"
#include "improve/curved/bends.h"

#include <algorithm>
#include <optional>

namespace octafront::curved {

namespace {

// As for the smooth surface of triangles (bends.cpp): more is not resolved by the mesh; less is rounding.
constexpr double kMostTrueBend = 0.2, kMostTrueMove = 0.5;
/// Corners go this far in steps, one a round; together with a neighbour whose way leads so far along theirs.
constexpr double kFarthestTrueMove = 2, kAlong = 0.5;
constexpr double kStraightTrueBend = 1e-9;

/// Faces of the mesh that lie on the geometry, and where their corners and edges belong.
class TrueSearch {
 public:
  TrueSearch(const TetMesh& mesh, const TrueGeometry& geometry)
      : mesh_(mesh), geometry_(geometry), faces_(mesh.boundary), patch_(mesh.patch) {
    patch_.resize(faces_.size());
    faces_.insert(faces_.end(), mesh.interfaces.begin(), mesh.interfaces.end());
    std::vector<std::uint32_t> inside = mesh.interface_patch;
    inside.resize(mesh.interfaces.size());
    patch_.insert(patch_.end(), inside.begin(), inside.end());
    table_ = make_edge_table(mesh.points.size(), faces_);
    find_patches();
  }

  Bends run() {
    Bends bends;
    too_far_.assign(mesh_.points.size(), 0);
    std::vector<std::optional<Vec3>> moved(mesh_.points.size());
    parallel_for(moved.size(), [&](std::size_t v) { moved[v] = move_of(static_cast<VertexIndex>(v)); });
    bends.too_far = static_cast<std::size_t>(std::count(too_far_.begin(), too_far_.end(), 1));
    take_steps(moved);
    for (VertexIndex v = 0; v < moved.size(); ++v)
      if (moved[v] && *moved[v] != Vec3{}) bends.corners.push_back({v, *moved[v]});
    std::vector<std::optional<Vec3>> bend(table_.size());
    parallel_for(table_.size(), [&](std::size_t e) { bend[e] = bend_of(e, moved); });
    for (std::size_t e = 0; e < bend.size(); ++e)
      if (bend[e]) bends.edges.push_back({table_.edges[e], *bend[e]});
    return bends;
  }

 private:
  using Patches = std::vector<std::uint32_t>;

  void find_patches() {
    patches_of_.resize(mesh_.points.size());
    shortest_.assign(mesh_.points.size(), 0);
    for (std::size_t f = 0; f < faces_.size(); ++f)
      for (const VertexIndex v : faces_[f]) patches_of_[v].push_back(patch_[f]);
    for (Patches& p : patches_of_) {
      std::sort(p.begin(), p.end());
      p.erase(std::unique(p.begin(), p.end()), p.end());
    }
    for (const Edge& edge : table_.edges) {
      const double l = distance(mesh_.points[edge[0]], mesh_.points[edge[1]]);
      for (const VertexIndex v : edge) shortest_[v] = shortest_[v] == 0 ? l : std::min(shortest_[v], l);
    }
  }

  /// Where p belongs that lies on these patches: where they meet, or if that is farther than `most`, on the nearest.
  std::optional<Vec3> target(const Patches& patches, Vec3 p, double most) const {
    if (patches.size() > 1)
      if (const auto on = geometry_.on_edge(patches, p); on && distance(*on, p) <= most) return on;
    std::optional<Vec3> best;
    for (const std::uint32_t patch : patches)
      if (const auto on = geometry_.on_face(patch, p))
        if (!best || squared_length(*on - p) < squared_length(*best - p)) best = on;
    return best;
  }

  /// Nothing for what stays because its place is not known, or too far.
  std::optional<Vec3> move_of(VertexIndex v) {
    if (patches_of_[v].empty()) return std::nullopt;
    const Vec3 p = mesh_.points[v];
    if (geometry_.is_vertex(p)) return Vec3{};
    const double most = kMostTrueMove * shortest_[v];
    const auto to = target(patches_of_[v], p, most);
    if (!to || !is_finite(*to)) return std::nullopt;
    const double way = distance(*to, p);
    too_far_[v] = way > most;
    if (way > kFarthestTrueMove * shortest_[v]) return std::nullopt;
    return *to - p;
  }

  /// Of the way of those that are too far only a step, and that where most neighbours go along: a whole face may lie
  /// beside the geometry, but a vertex alone would press its elements flat.
  void take_steps(std::vector<std::optional<Vec3>>& moved) const {
    std::vector<std::uint32_t> beside(moved.size(), 0), along(moved.size(), 0);
    const auto look = [&](VertexIndex v, VertexIndex u) {
      if (!too_far_[v] || !moved[v]) return;
      ++beside[v];
      along[v] += moved[u] && dot(*moved[u], *moved[v]) > kAlong * squared_length(*moved[v]);
    };
    for (const auto& [a, b] : table_.edges) look(a, b), look(b, a);
    for (std::size_t v = 0; v < moved.size(); ++v) {
      if (!too_far_[v] || !moved[v]) continue;
      if (2 * along[v] < beside[v])
        moved[v].reset();
      else
        *moved[v] = kMostTrueMove * shortest_[v] / length(*moved[v]) * *moved[v];
    }
  }

  std::optional<Vec3> bend_of(std::size_t e, const std::vector<std::optional<Vec3>>& moved) const {
    const auto& [a, b] = table_.edges[e];
    if (!moved[a] || !moved[b] || too_far_[a] || too_far_[b]) return std::nullopt;
    Patches patches;
    for (const std::uint32_t h : table_.uses(e)) patches.push_back(patch_[h / 3]);
    std::sort(patches.begin(), patches.end());
    patches.erase(std::unique(patches.begin(), patches.end()), patches.end());
    const Vec3 from = mesh_.points[a] + *moved[a], to = mesh_.points[b] + *moved[b], middle = 0.5 * (from + to);
    const auto on = target(patches, middle, kMostTrueBend * distance(from, to));
    if (!on || !is_finite(*on)) return std::nullopt;
    const double part = distance(*on, middle) / distance(from, to);
    if (!(part > kStraightTrueBend && part <= kMostTrueBend)) return std::nullopt;
    return *on - middle;
  }

  const TetMesh& mesh_;
  const TrueGeometry& geometry_;
  std::vector<Triangle> faces_;  ///< the boundary, and interfaces
  std::vector<std::uint32_t> patch_;
  EdgeTable table_;
  std::vector<Patches> patches_of_;  ///< per vertex
  std::vector<double> shortest_;     ///< edge at a vertex
  std::vector<char> too_far_;        ///< per vertex
};

}  // namespace

Bends find_bends(const TetMesh& mesh, const TrueGeometry& geometry) {
  return TrueSearch(mesh, geometry).run();
}

}  // namespace octafront::curved
