#include "base/core/parallel.h"
#include "base/mesh/edge_table.h"
#include "base/mesh/face_table.h"
#include "improve/curved/bends.h"
#include "improve/curved/node_places.h"

#include <algorithm>
#include <optional>

namespace octafront::curved {

namespace {

// More is not resolved by the mesh; less is rounding. A quarter of a circle bends by .21 of its chord.
constexpr double kMostTrueBend = 0.3, kMostTrueMove = 0.5;
/// Corners go this far in steps, one a round; together with a neighbour whose way leads so far along theirs.
constexpr double kFarthestTrueMove = 2, kSameWay = 0.5;
constexpr double kStraightTrueBend = 1e-9;

/// Faces of the mesh that lie on the geometry, and where their corners and edges belong.
class TrueSearch {
 public:
  TrueSearch(const TetMesh& mesh, const TrueGeometry& geometry, int order)
      : mesh_(mesh), geometry_(geometry), order_(order), faces_(mesh.boundary), patch_(mesh.patch) {
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
    take_steps(moved);
    bends.too_far = static_cast<std::size_t>(std::count(too_far_.begin(), too_far_.end(), 1));
    for (VertexIndex v = 0; v < moved.size(); ++v)
      if (moved[v] && *moved[v] != Vec3{}) bends.corners.push_back({v, *moved[v]});
    bulge_.assign(table_.size(), {});
    if (order_ > 2) parallel_for(table_.size(), [&](std::size_t e) { bulge_[e] = bulge_of(e, moved); });
    std::vector<std::optional<NodeMoves>> bend(table_.size());
    parallel_for(table_.size(), [&](std::size_t e) { bend[e] = bend_of(e, moved); });
    for (std::size_t e = 0; e < bend.size(); ++e)
      if (bend[e]) bends.edges.push_back({table_.edges[e], *bend[e]});
    if (nodes_in_face(order_) > 0) add_faces(moved, bends);
    return bends;
  }

 private:
  using Patches = std::vector<std::uint32_t>;

  void add_faces(const std::vector<std::optional<Vec3>>& moved, Bends& bends) const {
    std::vector<std::optional<NodeMoves>> bend(faces_.size());
    parallel_for(faces_.size(), [&](std::size_t f) { bend[f] = bend_of_face(f, moved); });
    for (std::size_t f = 0; f < faces_.size(); ++f)
      if (bend[f]) bends.faces.push_back({face_key(faces_[f]), *bend[f]});
    std::ranges::sort(bends.faces, {}, &FaceBend::face);
  }

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

  /// Where the patches meet, nearest to p, if that is no farther than `most`.
  std::optional<Vec3> on_line(const Patches& patches, Vec3 p, double most) const {
    if (patches.size() < 2) return std::nullopt;
    const auto on = geometry_.on_edge(patches, p);
    return on && distance(*on, p) <= most ? on : std::nullopt;
  }

  /// On the nearest of the patches.
  std::optional<Vec3> on_patch(const Patches& patches, Vec3 p) const {
    std::optional<Vec3> best;
    for (const std::uint32_t patch : patches)
      if (const auto on = geometry_.on_face(patch, p); on && is_finite(*on))
        if (!best || squared_length(*on - p) < squared_length(*best - p)) best = on;
    return best;
  }

  /// The way to where the patches of v meet, or else to the nearest of them. Nothing for what stays because its place
  /// is not known, or too far.
  std::optional<Vec3> move_of(VertexIndex v) {
    if (patches_of_[v].empty()) return std::nullopt;
    const Vec3 p = mesh_.points[v];
    if (geometry_.is_vertex(p)) return Vec3{};
    const auto line = on_line(patches_of_[v], p, kFarthestTrueMove * shortest_[v]);
    const auto to = line ? line : on_patch(patches_of_[v], p);
    if (!to) return std::nullopt;
    const double way = distance(*to, p);
    too_far_[v] = way > kMostTrueMove * shortest_[v];
    if (way > kFarthestTrueMove * shortest_[v]) return std::nullopt;
    return *to - p;
  }

  /// Of the way of those that are too far only a step, and that where most neighbours go along, of a line those on it:
  /// a whole face may lie beside the geometry, but a vertex alone would press its elements flat.
  void take_steps(std::vector<std::optional<Vec3>>& moved) {
    const std::vector<char> together = who_goes_together(moved);
    for (std::size_t v = 0; v < moved.size(); ++v) {
      if (!too_far_[v] || !moved[v]) continue;
      if (together[v] != 0)
        *moved[v] = kMostTrueMove * shortest_[v] / length(*moved[v]) * *moved[v];
      else
        moved[v] = to_patch(v);
    }
  }

  std::vector<char> who_goes_together(const std::vector<std::optional<Vec3>>& moved) const {
    std::vector<std::uint32_t> beside(moved.size(), 0), along(moved.size(), 0);
    const auto look = [&](VertexIndex v, VertexIndex u) {
      if (!too_far_[v] || !moved[v]) return;
      if (shared_patches(v, u) < std::min<std::size_t>(2, patches_of_[v].size())) return;
      ++beside[v];
      along[v] += moved[u] && dot(*moved[u], *moved[v]) > kSameWay * squared_length(*moved[v]);
    };
    for (const auto& [a, b] : table_.edges) look(a, b), look(b, a);
    std::vector<char> together(moved.size(), 0);
    for (std::size_t v = 0; v < moved.size(); ++v) together[v] = beside[v] > 0 && 2 * along[v] >= beside[v];
    return together;
  }

  std::size_t shared_patches(VertexIndex v, VertexIndex u) const {
    const Patches& of = patches_of_[u];
    return static_cast<std::size_t>(std::count_if(patches_of_[v].begin(), patches_of_[v].end(), [&](std::uint32_t p) {
      return std::binary_search(of.begin(), of.end(), p);
    }));
  }

  /// For a vertex whose line is too far: to a patch of it, if that is near.
  std::optional<Vec3> to_patch(std::size_t v) {
    const Vec3 p = mesh_.points[v];
    const auto to = on_patch(patches_of_[v], p);
    if (!to || distance(*to, p) > kMostTrueMove * shortest_[v]) return std::nullopt;
    too_far_[v] = 0;
    return *to - p;
  }

  bool stays_away(VertexIndex v, const std::vector<std::optional<Vec3>>& moved) const {
    return !moved[v] || too_far_[v] != 0;
  }

  Patches patches_of_edge(std::size_t e) const {
    Patches patches;
    for (const std::uint32_t h : table_.uses(e)) patches.push_back(patch_[h / 3]);
    std::sort(patches.begin(), patches.end());
    patches.erase(std::unique(patches.begin(), patches.end()), patches.end());
    return patches;
  }

  /// Where the corners will be; nothing if one stays away.
  template <std::size_t kCorners>
  std::optional<std::array<Vec3, kCorners>> places_of(const std::array<VertexIndex, kCorners>& corners,
                                                      const std::vector<std::optional<Vec3>>& moved) const {
    std::array<Vec3, kCorners> at;
    for (std::size_t i = 0; i < kCorners; ++i) {
      if (stays_away(corners[i], moved)) return std::nullopt;
      at[i] = mesh_.points[corners[i]] + *moved[corners[i]];
    }
    return at;
  }

  /// Near `from` on the line of an edge, or else on a patch of it.
  std::optional<Vec3> on_edge(const Patches& patches, Vec3 from, double size) const {
    const auto on = on_line(patches, from, kMostTrueBend * size);
    return on ? on : on_patch(patches, from);
  }

  /// How far the middle of an edge lies off the straight one's.
  Vec3 bulge_of(std::size_t e, const std::vector<std::optional<Vec3>>& moved) const {
    const auto ends = places_of(table_.edges[e], moved);
    if (!ends) return {};
    const double size = distance((*ends)[0], (*ends)[1]);
    const Vec3 from = in_edge(2, 0).mean_of(*ends);
    const auto on = on_edge(patches_of_edge(e), from, size);
    return on && distance(*on, from) <= kMostTrueBend * size ? *on - from : Vec3{};
  }

  std::optional<NodeMoves> bend_of(std::size_t e, const std::vector<std::optional<Vec3>>& moved) const {
    const auto ends = places_of(table_.edges[e], moved);
    if (!ends) return std::nullopt;
    const Patches patches = patches_of_edge(e);
    const double size = distance((*ends)[0], (*ends)[1]);
    NodeMoves by{};
    double most = 0;
    for (std::size_t k = 0; k < nodes_in_edge(order_); ++k) {
      const NodePlace<2> place = in_edge(order_, k);
      const Vec3 straight = place.mean_of(*ends);
      const auto on = on_edge(patches, straight + part_of_parabola(order_) * place.on_parabolas({&bulge_[e], 1}), size);
      if (!on) return std::nullopt;
      by[k] = *on - straight;
      most = std::max(most, length(by[k]) / size);
    }
    if (!(most > kStraightTrueBend && most <= kMostTrueBend)) return std::nullopt;
    return by;
  }

  std::optional<NodeMoves> bend_of_face(std::size_t f, const std::vector<std::optional<Vec3>>& moved) const {
    const Triangle corners = face_key(faces_[f]);
    const auto at = places_of(corners, moved);
    if (!at) return std::nullopt;
    const auto& [a, b, c] = *at;
    const double size = std::max({distance(a, b), distance(b, c), distance(c, a)});
    const std::array<Vec3, 3> bulges = bulges_of_face(table_, bulge_, corners);
    NodeMoves by{};
    for (std::size_t k = 0; k < nodes_in_face(order_); ++k) {
      const NodePlace<3> place = in_face(order_, k);
      const Vec3 straight = place.mean_of(*at);
      const auto on = on_patch({patch_[f]}, straight + part_of_parabola(order_) * place.on_parabolas(bulges));
      if (!on || !(distance(*on, straight) <= kMostTrueBend * size)) return std::nullopt;
      by[k] = *on - straight;
    }
    return by;
  }

  const TetMesh& mesh_;
  const TrueGeometry& geometry_;
  int order_;
  std::vector<Triangle> faces_;  ///< the boundary, and interfaces
  std::vector<std::uint32_t> patch_;
  EdgeTable table_;
  std::vector<Patches> patches_of_;  ///< per vertex
  std::vector<double> shortest_;     ///< edge at a vertex
  std::vector<char> too_far_;        ///< per vertex
  std::vector<Vec3> bulge_;          ///< per edge; of orders above 2
};

}  // namespace

Bends find_bends(const TetMesh& mesh, const TrueGeometry& geometry, int order) {
  return TrueSearch(mesh, geometry, order).run();
}

}  // namespace octafront::curved
