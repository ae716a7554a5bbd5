#include "base/dual/dual_faces.h"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

namespace octafront::dual {
namespace {

/// Takes out what a polygon goes to and at once comes back from, and points that follow themselves.
void reduce(std::vector<std::uint32_t>& polygon) {
  for (bool again = true; again;) {
    again = false;
    for (std::size_t i = 0; i < polygon.size() && polygon.size() > 2;) {
      const std::size_t n = polygon.size(), next = (i + 1) % n, before = (i + n - 1) % n;
      if (polygon[i] != polygon[next] && polygon[before] != polygon[next]) {
        ++i;
        continue;
      }
      polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(i));
      again = true;
    }
  }
}

class FaceMaker {
 public:
  FaceMaker(const Primal& primal, const DualCells& cells, const DualPoints& points)
      : primal_(primal), cells_(cells), points_(points) {}

  DualFaces made;

  void make(VertexIndex v) {
    for_each_edge(primal_, v, room_, at_edge_, [&](VertexIndex w, std::span<const Corner> at) {
      if (w < v) return;
      primal_.for_each_chain(
          at, w, spokes_, [&](std::span<const Spoke> chain, bool is_closed) { make_around(v, w, chain, is_closed); });
    });
    if (!cells_.is_plain[v]) make_at(v);
  }

 private:
  std::uint32_t cell(Corner c) const { return cells_.of_corner[c]; }

  /// Adds the polygon in room, whose normal points from one cell to the other one.
  void add(std::uint32_t from, std::uint32_t to, std::uint32_t patch) {
    reduce(polygon_);
    if (from == to || polygon_.size() < 3) return;
    if (to < from) std::swap(from, to), std::reverse(polygon_.begin(), polygon_.end());
    made.faces.push_back({from, to, patch, static_cast<std::uint32_t>(polygon_.size())});
    made.points.insert(made.points.end(), polygon_.begin(), polygon_.end());
  }

  // Around an edge.

  bool is_cut(const Spoke& a, const Spoke& b) const { return cell(a.from) != cell(b.from) || cell(a.to) != cell(b.to); }

  /// Whether cells end at the third corner of the face between two tetrahedra. Then it has a point.
  bool has_point(const Spoke& a, const Spoke& b) const { return cell(a.at_exit()) != cell(b.at_entry()); }

  /// Where faces end at an edge on top of layers, the face between the columns at its ends goes through it.
  std::optional<Edge> bent_top(const Spoke& a, const Spoke& b) const {
    const LayerCell *here = primal_.layers.of(a.tet()), *there = primal_.layers.of(b.tet());
    if (here == nullptr || there == nullptr || here == there) return std::nullopt;
    const auto top = points_.top_of(a.exit);
    const bool is_bent = top && points_.middle((*top)[0], (*top)[1]) != Middle::kLeftOut;
    if (!is_bent || !ends_above(*here, *top) || !ends_above(*there, *top)) return std::nullopt;
    return top;
  }
  bool ends_above(const LayerCell& layer, const Edge& top) const {
    const HalfFace other = primal_.across[layer.ceiling];
    return other == kNone || std::ranges::any_of(top, [&](VertexIndex v) {
             return cell(primal_.corner_at(layer.ceiling / 4, v)) != cell(primal_.corner_at(other / 4, v));
           });
  }
  /// Tetrahedra that have the edge on top have a part in the face around the one below it.
  bool is_below(const Spoke& s) const {
    const LayerCell* layer = primal_.layers.of(s.tet());
    return layer != nullptr && layer->has_on_top(primal_.vertex_of(s.from), primal_.vertex_of(s.to));
  }

  /// Adds the points of tetrahedra, and of faces between them.
  template <class At>
  void add_points(const At& at, std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      polygon_.push_back(points_.of_tet(at(k).tet()));
      if (k + 1 == end) break;
      if (has_point(at(k), at(k + 1)))
        polygon_.push_back(points_.of_face(at(k).exit));
      else if (const auto top = bent_top(at(k), at(k + 1)))
        polygon_.push_back(points_.of_edge((*top)[0], (*top)[1]));
    }
  }

  /// A face for each stretch of tetrahedra between two faces at which cells end.
  void make_around(VertexIndex v, VertexIndex w, std::span<const Spoke> chain, bool is_closed) {
    const std::size_t n = chain.size();
    std::size_t first = 0;
    if (is_closed)
      while (first < n && !is_cut(chain[(first + n - 1) % n], chain[first])) ++first;
    if (first == n) {  // none ends here
      polygon_.clear();
      // The first one comes once more at the end, after the face that may lie between.
      add_points([&](std::size_t k) -> const Spoke& { return chain[k % n]; }, 0, n + 1);
      return add(cell(chain[0].from), cell(chain[0].to), kNone);
    }
    const bool has_middle = points_.middle(v, w) != Middle::kLeftOut;
    for (std::size_t i = 0, end = 0; i < n; i = end) {
      const auto at = [&](std::size_t k) -> const Spoke& { return chain[(first + k) % n]; };
      while (end < n && (end == i || !is_cut(at(end - 1), at(end)))) ++end;
      bool are_below = true;
      for (std::size_t k = i; k < end; ++k) are_below = are_below && is_below(at(k));
      if (are_below) continue;
      polygon_.clear();
      if (has_middle) polygon_.push_back(points_.of_edge(v, w));
      polygon_.push_back(points_.of_face(at(i).entry));
      add_points(at, i, end);
      polygon_.push_back(points_.of_face(at(end - 1).exit));
      add(cell(at(i).from), cell(at(i).to), kNone);
    }
  }

  // At a vertex.

  /// The part at the vertex of a face at which cells end, seen from one side.
  struct Leaf {
    HalfFace face;
    std::uint32_t cell, beyond, patch;
    std::array<VertexIndex, 2> ends;  ///< counter-clockwise behind the vertex
    std::array<std::uint32_t, 2> next{kNone, kNone};
    bool is_done = false;
  };

  void add_leaf(HalfFace h, VertexIndex v, std::uint32_t here, std::uint32_t beyond) {
    Triangle t = corners_of(primal_.mesh.tets, h);
    while (t[0] != v) std::rotate(t.begin(), t.begin() + 1, t.end());
    leaves_.push_back({h, here, beyond, primal_.patch_of(h), {t[1], t[2]}});
  }

  /// All leaves, seen from the side of the lower cell.
  void find_leaves(VertexIndex v) {
    leaves_.clear();
    for (const Corner c : primal_.corners[v])
      for (HalfFace h = c - c % 4; h < c - c % 4 + 4; ++h) {
        if (h == c) continue;
        const HalfFace other = primal_.across[h];
        const std::uint32_t beyond = other == kNone ? kNone : cell(primal_.corner_at(other / 4, v));
        if (cell(c) < beyond) add_leaf(h, v, cell(c), beyond);
      }
  }

  /// Joins leaves at the edges that faces go past.
  void link_leaves(VertexIndex v) {
    ends_.clear();
    for (std::uint32_t l = 0; l < leaves_.size(); ++l)
      for (std::uint32_t side = 0; side < 2; ++side) ends_.emplace_back(leaves_[l].ends[side], 2 * l + side);
    std::sort(ends_.begin(), ends_.end());
    for (std::size_t i = 0; i + 1 < ends_.size(); ++i) {
      if (ends_[i].first != ends_[i + 1].first || points_.middle(v, ends_[i].first) == Middle::kCorner) continue;
      const std::uint32_t a = ends_[i].second, b = ends_[i + 1].second;
      leaves_[a / 2].next[a % 2] = b / 2;
      leaves_[b / 2].next[b % 2] = a / 2;
    }
  }

  void make_at(VertexIndex v) {
    find_leaves(v);
    if (leaves_.empty()) return;
    link_leaves(v);
    for (Leaf& leaf : leaves_)
      if (!leaf.is_done && leaf.next[0] == kNone) make_fan(v, leaf);
    for (Leaf& leaf : leaves_)
      if (!leaf.is_done) make_fan(v, leaf);
  }

  /// From a leaf that has none before it, or all around.
  void make_fan(VertexIndex v, Leaf& first) {
    polygon_.clear();
    const bool is_open = first.next[0] == kNone;
    if (is_open) polygon_ = {points_.of_vertex(v), points_.of_edge(v, first.ends[0])};
    Leaf* leaf = &first;
    while (true) {
      leaf->is_done = true;
      polygon_.push_back(points_.of_face(leaf->face));
      const VertexIndex end = leaf->ends[1];
      if (points_.middle(v, end) != Middle::kLeftOut) polygon_.push_back(points_.of_edge(v, end));
      if (leaf->next[1] == kNone || leaves_[leaf->next[1]].is_done) break;
      leaf = &leaves_[leaf->next[1]];
    }
    add(first.cell, first.beyond, first.patch);
  }

  const Primal& primal_;
  const DualCells& cells_;
  const DualPoints& points_;
  std::vector<std::pair<VertexIndex, Corner>> room_;
  std::vector<Corner> at_edge_;
  std::vector<Spoke> spokes_;
  std::vector<std::uint32_t> polygon_;
  std::vector<Leaf> leaves_;
  std::vector<std::pair<VertexIndex, std::uint32_t>> ends_;
};

}  // namespace

DualFaces faces_of_vertices(const Primal& primal, const DualCells& cells, const DualPoints& points, VertexIndex begin,
                            VertexIndex end) {
  FaceMaker maker(primal, cells, points);
  for (VertexIndex v = begin; v < end; ++v) maker.make(v);
  return std::move(maker.made);
}

}  // namespace octafront::dual
