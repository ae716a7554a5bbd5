#include "base/dual/dual_points.h"

#include "base/core/parallel.h"
#include "base/dual/lift.h"
#include "base/geometry/measures.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace octafront::dual {
namespace {

constexpr std::size_t kRange = 4096;

/// A face at an edge at which cells end, at one end of the edge or both.
struct Cut {
  HalfFace face;
  std::uint32_t patch;
  std::array<std::uint32_t, 2> at_from, at_to;  ///< the cells beside it, ascending; the same: none ends

  auto parts() const { return std::tie(patch, at_from, at_to); }
};

/// Faces of the dual are plane and stand upright on edges where its points are circumcentres. As far towards it as all
/// barycentric coordinates stay above this: sum of four is one, a quarter each in the middle.
constexpr double kLeastCoordinate = 0.15;

Vec3 towards_circumcentre(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const Vec3 u = b - a, v = c - a, w = d - a, vw = cross(v, w), wu = cross(w, u), uv = cross(u, v);
  const double det = dot(u, vw);
  const Vec3 to_circumcentre = (squared_length(u) * vw + squared_length(v) * wu + squared_length(w) * uv) / (2 * det);
  const double of_b = dot(to_circumcentre, vw) / det, of_c = dot(to_circumcentre, wu) / det,
               of_d = dot(to_circumcentre, uv) / det;
  const double least = std::min({1 - of_b - of_c - of_d, of_b, of_c, of_d});
  const double part = least >= kLeastCoordinate ? 1 : (0.25 - kLeastCoordinate) / (0.25 - least);
  return centroid(a, b, c, d) + (to_circumcentre - (u + v + w) / 4) * part;
}

class EdgeJudge {
 public:
  EdgeJudge(const Primal& primal, const DualCells& cells) : primal_(primal), cells_(cells) {}

  /// `top_of`: where sides of layers end.
  template <class TopOf>
  Middle middle(VertexIndex a, VertexIndex b, std::span<const Corner> at_edge, const TopOf& top_of) {
    find_cuts(b, at_edge);
    if (cuts_.empty()) return Middle::kLeftOut;
    if (cuts_.size() != 2 || cuts_[0].parts() != cuts_[1].parts()) return Middle::kCorner;
    // The diagonal of a quadrilateral on the side of layers.
    const std::optional<Edge> top = top_of(cuts_[0].face);
    const bool is_diagonal = top && top == top_of(cuts_[1].face);
    if (!is_diagonal && is_feature(a, b)) return Middle::kCorner;
    return primal_.layers.is_upright(a, b) || primal_.layers.is_upright(b, a) ? Middle::kPassed : Middle::kLeftOut;
  }

 private:
  std::array<std::uint32_t, 2> pair_of(Corner c, Corner other) const {
    const std::uint32_t here = cells_.of_corner[c], there = other == kNone ? kNone : cells_.of_corner[other];
    return {std::min(here, there), std::max(here, there)};
  }
  void add(HalfFace face, const Spoke& here, const Spoke* there) {
    const Cut cut{face, primal_.patch_of(face), pair_of(here.from, there == nullptr ? kNone : there->from),
                  pair_of(here.to, there == nullptr ? kNone : there->to)};
    if (cut.at_from[0] != cut.at_from[1] || cut.at_to[0] != cut.at_to[1]) cuts_.push_back(cut);
  }
  void find_cuts(VertexIndex to, std::span<const Corner> at_edge) {
    cuts_.clear();
    primal_.for_each_chain(at_edge, to, spokes_, [&](std::span<const Spoke> chain, bool is_closed) {
      if (!is_closed) add(chain.front().entry, chain.front(), nullptr);
      for (std::size_t i = 0; i + 1 < chain.size(); ++i) add(chain[i].exit, chain[i], &chain[i + 1]);
      is_closed ? add(chain.back().exit, chain.back(), &chain.front()) : add(chain.back().exit, chain.back(), nullptr);
    });
  }
  bool is_feature(VertexIndex a, VertexIndex b) const {
    if (!primal_.is_wall(cuts_[0].face) || !primal_.is_wall(cuts_[1].face)) return false;
    if (primal_.is_curve(a, b)) return true;
    // Of interfaces either side may be in front: one walks from one to the other in the direction of the chain.
    const std::vector<Vec3>& p = primal_.mesh.points;
    const auto into = [&](HalfFace h) {
      const Triangle t = corners_of(primal_.mesh.tets, h);
      const VertexIndex besides = third(t, a, b);
      return cross(p[b] - p[a], p[besides] - p[a]);
    };
    return dot(normalized(into(cuts_[0].face)), normalized(-into(cuts_[1].face))) < kFeatureCosine;
  }

  const Primal& primal_;
  const DualCells& cells_;
  std::vector<Spoke> spokes_;
  std::vector<Cut> cuts_;
};

}  // namespace

DualPoints::DualPoints(const Primal& primal, const DualCells& cells) : primal_(primal), cells_(cells) {
  find_edges();
  find_faces();
  is_centred_.assign(first_edge(), false);
}

void DualPoints::find_edges() {
  edges_ = parallel_collect<MarkedEdge>(
      primal_.mesh.points.size(), kRange, [&](std::size_t begin, std::size_t end, std::vector<MarkedEdge>& out) {
        EdgeJudge judge(primal_, cells_);
        std::vector<std::pair<VertexIndex, Corner>> room;
        std::vector<Corner> at_edge;
        for (std::size_t i = begin; i < end; ++i) {
          const auto v = static_cast<VertexIndex>(i);
          for_each_edge(primal_, v, room, at_edge, [&](VertexIndex w, std::span<const Corner> at) {
            if (w < v || (cells_.is_plain[v] && cells_.is_plain[w])) return;
            const Middle m = judge.middle(v, w, at, [&](HalfFace h) { return top_of(h); });
            if (m != Middle::kLeftOut) out.push_back({{v, w}, m});
          });
        }
      });
}

void DualPoints::find_faces() {
  std::vector<MarkedEdge> tops;
  for (HalfFace h = 0; h < primal_.across.size(); ++h) {
    const HalfFace other = primal_.across[h];
    if (other < h) continue;
    const Triangle face = corners_of(primal_.mesh.tets, h);
    if (std::ranges::all_of(face, [&](VertexIndex v) { return cells_.is_plain[v] != 0; })) continue;
    const bool is_cut =
        other == kNone || std::ranges::any_of(face, [&](VertexIndex v) {
          return cells_.of_corner[primal_.corner_at(h / 4, v)] != cells_.of_corner[primal_.corner_at(other / 4, v)];
        });
    if (!is_cut || is_ceiling(h) || (other != kNone && is_ceiling(other))) continue;
    if (const auto top = top_of(h))
      tops.push_back({*top, Middle::kLeftOut});
    else
      faces_.push_back(h);
  }
  std::sort(tops.begin(), tops.end());
  const auto middle = static_cast<std::ptrdiff_t>(edges_.size());
  edges_.insert(edges_.end(), tops.begin(), tops.end());
  // Where an edge is there twice, the first one knows more.
  std::inplace_merge(edges_.begin(), edges_.begin() + middle, edges_.end());
  edges_.erase(std::unique(edges_.begin(), edges_.end(),
                           [](const MarkedEdge& a, const MarkedEdge& b) { return a.edge == b.edge; }),
               edges_.end());
}

bool DualPoints::is_ceiling(HalfFace h) const {
  const LayerCell* cell = primal_.layers.of(h / 4);
  return cell != nullptr && cell->ceiling == h;
}

std::optional<Edge> DualPoints::top_of(HalfFace h) const {
  if (const auto top = primal_.layers.top_of_side(primal_.mesh.tets, h)) return top;
  const HalfFace other = primal_.across[h];
  return other == kNone ? std::nullopt : primal_.layers.top_of_side(primal_.mesh.tets, other);
}

std::uint32_t DualPoints::of_tet(TetIndex t) const {
  const LayerCell* cell = primal_.layers.of(t);
  return cell == nullptr ? t : cell->first;
}

std::uint32_t DualPoints::of_face(HalfFace h) const {
  const HalfFace other = primal_.across[h];
  if (is_ceiling(h)) return of_tet(h / 4);
  if (other != kNone && is_ceiling(other)) return of_tet(other / 4);
  if (const auto top = top_of(h)) return of_edge((*top)[0], (*top)[1]);
  return first_face() +
         static_cast<std::uint32_t>(std::ranges::lower_bound(faces_, primal_.lower_side(h)) - faces_.begin());
}

const DualPoints::MarkedEdge* DualPoints::find(VertexIndex a, VertexIndex b) const {
  const auto at = std::lower_bound(edges_.begin(), edges_.end(), MarkedEdge{sorted_edge(a, b), {}});
  return at == edges_.end() || at->edge != sorted_edge(a, b) ? nullptr : &*at;
}

std::uint32_t DualPoints::of_edge(VertexIndex a, VertexIndex b) const {
  if (primal_.layers.is_upright(a, b)) return of_vertex(b);
  if (primal_.layers.is_upright(b, a)) return of_vertex(a);
  return first_edge() + static_cast<std::uint32_t>(find(a, b) - edges_.data());
}

Middle DualPoints::middle(VertexIndex a, VertexIndex b) const {
  const MarkedEdge* edge = find(a, b);
  return edge == nullptr ? Middle::kLeftOut : edge->middle;
}

Vec3 DualPoints::place(std::uint32_t point) const {
  const std::vector<Vec3>& p = primal_.mesh.points;
  if (point >= first_vertex()) return p[point - first_vertex()];
  if (point >= first_edge()) {
    const auto& [a, b] = edges_[point - first_edge()].edge;
    return (p[a] + p[b]) / 2;
  }
  if (point < first_face()) return place_in(point);
  const HalfFace face = faces_[point - first_face()];
  const auto& [a, b, c] = corners_of(primal_.mesh.tets, face);
  const Vec3 middle = centroid(p[a], p[b], p[c]);
  return primal_.is_wall(face) && !is_centred_[point] ? middle + lift(primal_, *this, face) : middle;
}

Vec3 DualPoints::place_in(TetIndex t) const {
  const std::vector<Vec3>& p = primal_.mesh.points;
  if (const LayerCell* cell = primal_.layers.of(t)) {
    // All layers over a face of the wall go along with it: so they stay as high as they are.
    const HalfFace ground = primal_.layers.ground_of(primal_.across, *cell);
    const Vec3 middle = centroid(p[cell->top[0]], p[cell->top[1]], p[cell->top[2]]);
    return primal_.is_wall(ground) ? middle + lift(primal_, *this, ground) : middle;
  }
  const auto& [a, b, c, d] = primal_.mesh.tets[t];
  return is_centred_[t] ? centroid(p[a], p[b], p[c], p[d]) : towards_circumcentre(p[a], p[b], p[c], p[d]);
}

}  // namespace octafront::dual
