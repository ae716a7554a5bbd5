#include "base/dual/dual_cells.h"

#include "base/core/disjoint_sets.h"
#include "base/core/parallel.h"
#include "base/geometry/measures.h"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

namespace octafront::dual {
namespace {

/// The corner whose cell a corner belongs to: itself, or in layers that below it.
class Owners {
 public:
  explicit Owners(const Primal& primal) : primal_(primal) {}

  Corner of(Corner corner) const {
    VertexIndex v = primal_.vertex_of(corner);
    TetIndex t = corner / 4;
    for (const LayerCell* cell = primal_.layers.of(t); cell != nullptr; cell = primal_.layers.of(t)) {
      const auto i = static_cast<std::size_t>(std::ranges::find(cell->top, v) - cell->top.begin());
      if (i == 3) break;
      if (!cell->is_ended(i)) return primal_.corner_at(cell->floor / 4, cell->bottom[i]);
      // The column has ended: its last cell reaches up to the cells beside it.
      const HalfFace below = primal_.across[cell->floor];
      if (primal_.is_wall(cell->floor)) break;
      t = below / 4;
    }
    return corner;
  }
  bool is_own(Corner corner) const { return primal_.layers.of(corner / 4) == nullptr || of(corner) == corner; }

 private:
  const Primal& primal_;
};

/// The corners at one vertex, put into cells.
class Star {
 public:
  explicit Star(const Primal& primal) : primal_(primal), owners_(primal) {}

  /// No wall and no layer is there.
  bool is_plain(VertexIndex v) const {
    return std::ranges::none_of(primal_.corners[v], [&](Corner c) {
      const HalfFace first = c - c % 4;
      if (primal_.layers.of(c / 4) != nullptr) return true;
      for (HalfFace h = first; h < first + 4; ++h)
        if (h != c && primal_.is_wall(h)) return true;
      return false;
    });
  }

  /// Writes the number of each own corner's cell, counted from 0 at each vertex. Returns how many there are.
  std::uint32_t number(VertexIndex v, Ridges ridges, std::vector<std::uint32_t>& cell_of) {
    vertex_ = v;
    corners_ = primal_.corners[v];
    is_own_.assign(corners_.size(), false);
    for (std::size_t i = 0; i < corners_.size(); ++i) is_own_[i] = owners_.is_own(corners_[i]);
    find_bounds();
    side_.assign(corners_.size(), 0);
    if (!bounds_.empty() && ridges != Ridges::kNone) {
      ridge_cosine_ = ridges == Ridges::kSharp ? kRidgeCosine : kFeatureCosine;
      divide_at_ridges();
    }
    return join(cell_of);
  }

 private:
  /// A face at which the cells at the vertex end.
  struct Bound {
    std::uint32_t corner;  ///< among those of the vertex
    HalfFace face;
  };

  std::uint32_t place_of(Corner c) const {
    return static_cast<std::uint32_t>(std::ranges::lower_bound(corners_, c) - corners_.begin());
  }
  /// Whether a face is the top of layers that have no column at the vertex: they thin out to nothing towards it, and
  /// what is left of them there goes to the cell above.
  bool is_taper(HalfFace h) const { return is_top_without_column(h) || is_top_without_column(primal_.across[h]); }
  bool is_top_without_column(HalfFace h) const {
    const LayerCell* cell = h == kNone ? nullptr : primal_.layers.of(h / 4);
    if (cell == nullptr || cell->ceiling != h || primal_.across[h] == kNone) return false;
    return owners_.of(primal_.corner_at(h / 4, vertex_)) / 4 == h / 4;
  }
  /// The corner beyond a face, among those of the vertex; kNone if cells end there.
  std::uint32_t beyond(HalfFace h) const {
    if (primal_.is_wall(h) && !is_taper(h)) return kNone;
    const std::uint32_t other = place_of(primal_.corner_at(primal_.across[h] / 4, vertex_));
    return is_own_[other] ? other : kNone;
  }
  template <class Visit>
  void for_each_face(std::uint32_t corner, const Visit& visit) const {
    const Corner c = corners_[corner];
    for (std::uint32_t i = 0; i < 4; ++i)
      if (i != c % 4) visit(c - c % 4 + i);
  }

  void find_bounds() {
    bounds_.clear();
    for (std::uint32_t i = 0; i < corners_.size(); ++i)
      if (is_own_[i])
        for_each_face(i, [&](HalfFace h) {
          if (beyond(h) == kNone) bounds_.push_back({i, h});
        });
  }

  std::uint32_t bound_at(HalfFace h) const {
    return static_cast<std::uint32_t>(std::ranges::lower_bound(bounds_, h, {}, &Bound::face) - bounds_.begin());
  }

  /// The bound on the other side of the material at an edge of this one.
  std::uint32_t across_edge(const Bound& from, VertexIndex w) const {
    return bound_at(primal_.end_across(from.face, vertex_, w, [&](HalfFace h) { return beyond(h) == kNone; }));
  }

  Vec3 normal(HalfFace h) const {
    const auto& [a, b, c] = corners_of(primal_.mesh.tets, h);
    const std::vector<Vec3>& p = primal_.mesh.points;
    return unit_normal(p[a], p[b], p[c]);
  }

  bool has_column(const LayerCell& cell) const {
    const auto i = static_cast<std::size_t>(std::ranges::find(cell.bottom, vertex_) - cell.bottom.begin());
    return i < 3 && !cell.is_ended(i);
  }
  bool is_floor(HalfFace h) const {
    const LayerCell* cell = primal_.layers.of(h / 4);
    return cell != nullptr && cell->floor == h && has_column(*cell);
  }

  enum class Bend { kSmooth, kConvex, kRidge };
  /// How the body bends at the edge between two bounds; inward at a ridge.
  Bend bend(const Bound& a, const Bound& b, VertexIndex w) const {
    const Vec3 n = normal(a.face);
    const double cosine = dot(n, normal(b.face));
    const VertexIndex besides = third(corners_of(primal_.mesh.tets, b.face), vertex_, w);
    const bool is_inward = dot(n, primal_.mesh.points[besides] - primal_.mesh.points[vertex_]) > 0;
    // A layer is thin: it is bent whichever way it goes over an edge.
    if (is_inward || (is_floor(a.face) && is_floor(b.face)))
      return cosine < ridge_cosine_ ? Bend::kRidge : Bend::kSmooth;
    return cosine < kFeatureCosine ? Bend::kConvex : Bend::kSmooth;
  }

  /// Gives each corner the side that it belongs to: smooth parts of the surface at ridges, and those that hang together
  /// with no ridge between them.
  void divide_at_ridges() {
    DisjointSets sides(bounds_.size());
    std::vector<std::array<std::uint32_t, 2>> ridges, convex;
    for (std::uint32_t b = 0; b < bounds_.size(); ++b)
      for (const VertexIndex w : corners_of(primal_.mesh.tets, bounds_[b].face)) {
        const std::uint32_t other = w == vertex_ ? b : across_edge(bounds_[b], w);
        if (other <= b) continue;
        const Bend at_edge = bend(bounds_[b], bounds_[other], w);
        if (at_edge == Bend::kSmooth) sides.join(b, other);
        if (at_edge == Bend::kConvex) convex.push_back({b, other});
        if (at_edge == Bend::kRidge) ridges.push_back({b, other});
      }
    if (ridges.empty()) return;
    std::vector<bool> is_at_ridge(bounds_.size(), false);
    for (const auto& [a, b] : ridges) is_at_ridge[sides.find(a)] = is_at_ridge[sides.find(b)] = true;
    inward_.assign(bounds_.size(), {});
    for (std::uint32_t b = 0; b < bounds_.size(); ++b) is_at_ridge[b] = is_at_ridge[sides.find(b)];
    join_across(convex, ridges, is_at_ridge, sides);
    for (std::uint32_t b = 0; b < bounds_.size(); ++b)
      if (is_at_ridge[b]) inward_[sides.find(b)] -= normal(bounds_[b].face);
    for (Vec3& n : inward_) n = normalized(n);
    std::ranges::fill(side_, kNone);
    for (std::uint32_t b = 0; b < bounds_.size(); ++b)
      if (is_at_ridge[b]) offer(bounds_[b].corner, sides.find(b));
    take_floors(sides);
    grow();
  }

  /// Joins sides over convex edges, unless they are two sides of a ridge.
  static void join_across(std::span<const std::array<std::uint32_t, 2>> convex,
                          std::span<const std::array<std::uint32_t, 2>> ridges, const std::vector<bool>& is_at_ridge,
                          DisjointSets& sides) {
    for (const auto& [a, b] : convex) {
      const std::uint32_t here = sides.find(a), there = sides.find(b);
      const bool are_apart = std::ranges::any_of(ridges, [&](const auto& ridge) {
        const std::uint32_t p = sides.find(ridge[0]), q = sides.find(ridge[1]);
        return (p == here && q == there) || (p == there && q == here);
      });
      if (is_at_ridge[a] && is_at_ridge[b] && !are_apart) sides.join(a, b);
    }
  }

  double depth(std::uint32_t corner, std::uint32_t side) const {
    const Tet& t = primal_.mesh.tets[corners_[corner] / 4];
    const std::vector<Vec3>& p = primal_.mesh.points;
    return dot(normalized(centroid(p[t[0]], p[t[1]], p[t[2]], p[t[3]]) - p[vertex_]), inward_[side]);
  }
  /// The side below which it lies deeper.
  void offer(std::uint32_t corner, std::uint32_t side) {
    if (side_[corner] == kNone || depth(corner, side) > depth(corner, side_[corner])) side_[corner] = side;
  }

  /// A wedge belongs as a whole to the side that it stands on.
  void take_floors(DisjointSets& sides) {
    for (std::uint32_t i = 0; i < corners_.size(); ++i) {
      const LayerCell* cell = is_own_[i] ? primal_.layers.of(corners_[i] / 4) : nullptr;
      if (cell == nullptr || !has_column(*cell)) continue;
      const std::uint32_t b = bound_at(cell->floor);
      if (b < bounds_.size() && bounds_[b].face == cell->floor) side_[i] = sides.find(b);
    }
  }

  /// The others follow those beside them, the deepest first.
  void grow() {
    while (true) {
      std::uint32_t best = kNone, side_of_best = kNone;
      double deepest = 0;
      for (std::uint32_t i = 0; i < corners_.size(); ++i) {
        if (!is_own_[i] || side_[i] != kNone) continue;
        for_each_face(i, [&](HalfFace h) {
          const std::uint32_t other = beyond(h), side = other == kNone ? kNone : side_[other];
          if (side == kNone) return;
          const double here = depth(i, side);
          if (best != kNone && here <= deepest) return;
          best = i, side_of_best = side, deepest = here;
        });
      }
      if (best == kNone) return;
      side_[best] = side_of_best;
    }
  }

  /// Corners of one side that hang together are a cell.
  std::uint32_t join(std::vector<std::uint32_t>& cell_of) {
    std::uint32_t cells = 0;
    for (const Corner c : corners_) cell_of[c] = kNone;
    for (std::uint32_t first = 0; first < corners_.size(); ++first) {
      if (!is_own_[first] || cell_of[corners_[first]] != kNone) continue;
      open_.assign(1, first);
      cell_of[corners_[first]] = cells;
      while (!open_.empty()) {
        const std::uint32_t i = open_.back();
        open_.pop_back();
        for_each_face(i, [&](HalfFace h) {
          const std::uint32_t other = beyond(h);
          if (other == kNone || side_[other] != side_[i] || cell_of[corners_[other]] != kNone) return;
          cell_of[corners_[other]] = cells;
          open_.push_back(other);
        });
      }
      ++cells;
    }
    return cells;
  }

  const Primal& primal_;
  Owners owners_;
  VertexIndex vertex_ = kNone;
  double ridge_cosine_ = kRidgeCosine;
  std::span<const Corner> corners_;
  std::vector<bool> is_own_;
  std::vector<Bound> bounds_;        ///< ascending by face
  std::vector<std::uint32_t> side_;  ///< per corner
  std::vector<Vec3> inward_;         ///< per side
  std::vector<std::uint32_t> open_;
};

}  // namespace

DualCells make_cells(const Primal& primal, const std::vector<Ridges>& ridges) {
  const std::size_t vertices = primal.mesh.points.size();
  DualCells cells;
  cells.of_corner.resize(4 * primal.mesh.tets.size());
  std::vector<std::uint32_t> first(vertices + 1, 0);
  PerThread<Star> stars;
  cells.is_plain.resize(vertices);
  parallel_for(vertices, [&](std::size_t i) {
    const auto v = static_cast<VertexIndex>(i);
    Star& star = stars.local([&] { return Star(primal); });
    cells.is_plain[v] = star.is_plain(v);
    if (!cells.is_plain[v]) first[v + 1] = star.number(v, ridges[v], cells.of_corner);
    if (!cells.is_plain[v] || primal.corners[v].empty()) return;
    for (const Corner c : primal.corners[v]) cells.of_corner[c] = 0;
    first[v + 1] = 1;
  });
  for (std::size_t v = 0; v < vertices; ++v) first[v + 1] += first[v];
  cells.vertex.resize(first[vertices]);
  cells.region.resize(first[vertices]);
  parallel_for(vertices, [&](std::size_t v) {
    for (std::uint32_t c = first[v]; c < first[v + 1]; ++c) cells.vertex[c] = static_cast<VertexIndex>(v);
    for (const Corner c : primal.corners[v])
      if (cells.of_corner[c] != kNone) cells.of_corner[c] += first[v];
    // What is left of layers in a cell above them does not count.
    for (const bool of_layers : {true, false})
      for (const Corner c : primal.corners[v])
        if (cells.of_corner[c] != kNone && (primal.layers.of(c / 4) != nullptr) == of_layers)
          cells.region[cells.of_corner[c]] = primal.region_of(c / 4);
  });
  const Owners owners(primal);
  parallel_for(cells.of_corner.size(), [&](std::size_t c) {
    // The owner has its number: it is never changed here.
    if (cells.of_corner[c] == kNone) cells.of_corner[c] = cells.of_corner[owners.of(static_cast<Corner>(c))];
  });
  return cells;
}

}  // namespace octafront::dual
