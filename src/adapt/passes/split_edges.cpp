// Splits of edges, each with all tets around it in two.

#include "adapt/passes/metric_passes.h"
#include "adapt/passes/worth.h"
#include "base/core/elementary.h"
#include "base/geometry/measures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace octafront::adapt {
namespace {

/// How far new vertices look for the ground, in edge lengths: the sagitta of half a circle.
constexpr double kReachOfSplit = 0.5;
/// The worst new element keeps this part of the worst old one's score.
constexpr float kLeastOfSplit = 0.1f;
/// What is poor already stays about as good: where the longest edge may not be split, splits of all others would draw
/// nearer and nearer to it.
constexpr float kLeastScoreOfSplit = 0.03f, kKeptOfPoor = 0.9f;
/// Rather than that walls stay off the ground by more than this, in lengths of the metric, they come so near to
/// vertices, which can go then.
constexpr double kFarFromHome = 0.1, kShortestAtHome = 0.2;
/// Edges longer than this do not wait so much.
constexpr double kMuchTooLong = 1.5;
/// Between ends whose lengths differ by less the middle is the middle.
constexpr double kEven = 0.2;
/// New vertices stay this far from the ends, in parts of the edge.
constexpr double kLeastPart = 0.2;
/// Edges inside become so many times as short as those of the rim: more would leave poor elements between them.
constexpr double kFinerThanRim = 2.5;
/// Less than one split for so many vertices does not make the inside finer: an edge of the rim that none of its pieces
/// may split must not keep them waiting for ever.
constexpr std::size_t kFewSplits = 16;
/// Where what mends divides edges.
constexpr std::array<double, 3> kPartsOfMending{0.5, 0.3, 0.7};
constexpr int kCheckEvery = 256;

class Splitter {
 public:
  Splitter(Piece& piece, const Guide& guide, bool mends, double shortest)
      : piece_(piece), guide_(guide), mends_(mends), shortest_(shortest) {}

  PassCount run(std::size_t most_vertices) {
    PassCount count;
    for (TetIndex t = 0; t < piece_.complex.slots(); ++t)
      if (piece_.complex.alive(t) && piece_.is_active(t)) enqueue(t);
    const int least = least_level();
    const std::size_t few = piece_.vertices.size() / kFewSplits;
    for (int level = kLevels - 1; level >= 0; --level) {
      if (level < least && count.done > few) {
        count.unfinished = true;
        return count;
      }
      // What comes of these may wait in the same list.
      for (std::size_t k = 0; k < waiting_[level].size(); ++k) {
        if (piece_.vertices.size() >= most_vertices) {
          count.unfinished = true;
          return count;
        }
        if (++steps_ % kCheckEvery == 0) guide_.context.check();
        const TetIndex t = waiting_[level][k];
        if (!piece_.complex.alive(t)) continue;
        const auto edge = longest_edge(t);
        if (!edge || level_of(edge->length) < level) continue;
        ++count.tried;
        const auto [a, b] = edge->ends;
        if (!split(t, a, b, middle(a, b))) {
          refused_.insert(sorted_edge(a, b));
          enqueue(t);
          continue;
        }
        ++count.done;
        for (const TetIndex made : piece_.created()) enqueue(made);
      }
      waiting_[level] = {};
    }
    return count;
  }

  /// Splits the longest edges of elements that are poor because of them.
  PassCount mend() {
    PassCount count;
    const TetIndex slots = piece_.complex.slots();
    for (TetIndex t = 0; t < slots; ++t) {
      if (!piece_.complex.alive(t) || !is_to_mend(piece_, t)) continue;
      if (++steps_ % kCheckEvery == 0) guide_.context.check();
      const auto edge = longest_edge(t);
      if (!edge || edge->length <= kLongOfPoor) continue;
      ++count.tried;
      const Edge ends = edge->ends;
      count.done += std::any_of(kPartsOfMending.begin(), kPartsOfMending.end(),
                                [&](double part) { return split(t, ends[0], ends[1], part); });
    }
    return count;
  }

 private:
  /// Lists of tets by the longest edge that may be split: from kLongest times 2^(level / 2) on.
  static constexpr int kLevels = 128;

  struct LongEdge {
    Edge ends;
    double length;
  };

  static int level_of(double length) {
    int level = 0;
    for (double limit = 2; limit < length && level + 1 < kLevels; limit *= kLongest) ++level;
    return level;
  }

  /// Edges of the rim wait for another piece: what is much shorter than they are does so, too.
  int least_level() const {
    double longest = 0;
    for (HalfFace h = 0; h < piece_.complex.across.size(); ++h) {
      if (piece_.complex.across[h] != kBeyondRim || !piece_.complex.alive(h / 4)) continue;
      const Triangle f = piece_.complex.face(h);
      for (int i = 0; i < 3; ++i)
        if (may_split(f[i], f[(i + 1) % 3])) longest = std::max(longest, piece_.edge_length(f[i], f[(i + 1) % 3]));
    }
    return level_of(longest / kFinerThanRim);
  }

  void enqueue(TetIndex t) {
    if (const auto edge = longest_edge(t)) waiting_[level_of(edge->length)].push_back(t);
  }

  bool may_split(VertexIndex a, VertexIndex b) const {
    const Vertex &p = piece_.vertices[a], &q = piece_.vertices[b];
    if (p.frozen && q.frozen) return false;
    return (mends_ || p.active || q.active) && !refused_.contains(sorted_edge(a, b));
  }

  /// The longest edge that is too long and may be split.
  std::optional<LongEdge> longest_edge(TetIndex t) const {
    std::optional<LongEdge> best;
    double limit = kLongest;
    const Tet& c = piece_.tet(t);
    for (const auto& [i, j] : kTetEdges) {
      if (piece_.is_longer(c[i], c[j], limit) && may_split(c[i], c[j]))
        limit = piece_.edge_length(c[i], c[j]), best = {{c[i], c[j]}, limit};
    }
    return best;
  }

  /// The place on the edge that halves its length, if lengths change by a constant factor along it.
  double middle(VertexIndex a, VertexIndex b) const {
    const Vertex &p = piece_.vertices[a], &q = piece_.vertices[b];
    const Vec3 e = q.at - p.at;
    const double ratio = std::sqrt(q.metric.squared(e) / p.metric.squared(e));
    if (!(std::abs(ratio - 1) > kEven)) return 0.5;
    return std::clamp(elementary::log((ratio + 1) / 2) / elementary::log(ratio), kLeastPart, 1 - kLeastPart);
  }

  /// Where the ground wants the new vertex; `straight` if it does not say.
  Vec3 home_of(VertexIndex a, VertexIndex b, Vec3 straight, const std::uint32_t* path) const {
    const double reach = kReachOfSplit * distance(piece_.point(a), piece_.point(b));
    if (path) return guide_.ground.on_line(straight, *path, reach).value_or(straight);
    if (walls_.empty()) return straight;
    Vec3 normal{};
    const bool outer = (walls_[0].wall & kOuter) != 0;
    for (const Piece::WallAt& w : walls_) {
      Vec3 n = double_area_normal(piece_.point(a), piece_.point(b), piece_.point(w.tip));
      // Seen along the edge the ring turns from the first wall to the last: outward is behind the first.
      if (outer && w.tip == ring_.ring.front()) n = -n;
      if (!outer && dot(n, normal) < 0) n = -n;
      normal += normalized(n);
    }
    std::uint32_t near = piece_.vertices[a].near;
    return guide_.ground.on_surface(straight, (walls_[0].wall & ~kOuter) - 1, outer, normal, reach, near)
        .value_or(straight);
  }

  bool split(TetIndex t, VertexIndex a, VertexIndex b, double part) {
    const std::uint32_t* path = piece_.line(a, b);
    if (path && *path == Parts::kStays) return false;
    if (!piece_.ring(t, a, b, ring_)) return false;
    piece_.walls_of(a, b, ring_, walls_);
    if (std::any_of(walls_.begin(), walls_.end(), [&](const Piece::WallAt& w) { return guide_.keeps(w.wall); }))
      return false;
    const Vec3 p = piece_.point(a), q = piece_.point(b), straight = p + part * (q - p);
    const Vec3 home = home_of(a, b, straight, path);
    Vertex made = between(piece_.vertices[a], piece_.vertices[b], part);
    made.kind = path ? Kind::kCurve : walls_.empty() ? Kind::kInner : Kind::kSurface;
    for (const double share : {1.0, 0.5, 0.0}) {
      if (share != 0 && home == straight) continue;
      made.at = straight + share * (home - straight);
      made.off = guide_.ground.given() && share != 1 && home != straight;
      guide_.ask(made);
      const bool is_needed = share == 1 && made.metric.squared(home - straight) > kFarFromHome * kFarFromHome;
      if (mends_ ? plan_mending(a, b, made) : plan(a, b, made, is_needed ? kShortestAtHome : shortest_))
        return apply(a, b, made, path);
    }
    return false;
  }

  bool plan(VertexIndex a, VertexIndex b, const Vertex& made, double shortest) {
    float worst = 1;
    for (const TetIndex t : ring_.tets) worst = std::min(worst, piece_.score[t]);
    float least = kLeastOfSplit * worst;
    if (least < kLeastScoreOfSplit && !is_longest_around(a, b))
      least = std::max(least, std::min(kLeastScoreOfSplit, kKeptOfPoor * worst));
    if (made.exact) {
      const double excess = std::max(piece_.edge_length(a, b) / kMuchTooLong, 1.0);
      shortest /= excess * excess;
    }
    for (const VertexIndex r : ring_.ring) {
      if (piece_.is_shorter(made, piece_.vertices[r], shortest)) return false;
    }
    return plan_tets(a, b, made, least, [&](const auto&, float score) { return score; });
  }

  /// Whether the worst element becomes better.
  bool plan_mending(VertexIndex a, VertexIndex b, const Vertex& made) {
    float worst = HUGE_VALF;
    for (const TetIndex t : ring_.tets) worst = std::min(worst, worth_of(piece_, piece_.tet(t)));
    return plan_tets(a, b, made, kGainOfMending * worst,
                     [&](const auto& corners, float) { return worth_of_corners(corners, piece_); });
  }

  /// The new tets, if all are of more value(corners, score) than `least`.
  template <class Value>
  bool plan_tets(VertexIndex a, VertexIndex b, const Vertex& made, float least, const Value& value) {
    fresh_.clear();
    const auto next = static_cast<VertexIndex>(piece_.vertices.size());
    for (const TetIndex t : ring_.tets)
      for (const VertexIndex gone : {b, a}) {
        Tet c = piece_.tet(t);
        std::array<const Vertex*, 4> corners;
        for (std::size_t i = 0; i < 4; ++i) corners[i] = c[i] == gone ? &made : &piece_.vertices[c[i]];
        const float s = piece_.score_of_corners(corners);
        if (!(s > 0) || !(value(corners, s) > least)) return false;
        std::replace(c.begin(), c.end(), gone, next);
        fresh_.push_back({c, piece_.region[t], s});
      }
    return true;
  }

  /// Whether no tet around the edge has a longer one.
  bool is_longest_around(VertexIndex a, VertexIndex b) const {
    const double l = piece_.edge_length(a, b);
    return std::all_of(ring_.tets.begin(), ring_.tets.end(), [&](TetIndex t) {
      const Tet& c = piece_.tet(t);
      return std::all_of(kTetEdges.begin(), kTetEdges.end(),
                         [&](const auto& e) { return !piece_.is_longer(c[e[0]], c[e[1]], l); });
    });
  }

  bool apply(VertexIndex a, VertexIndex b, const Vertex& made, const std::uint32_t* path) {
    const auto v = static_cast<VertexIndex>(piece_.vertices.size());
    piece_.vertices.push_back(made);
    piece_.complex.tet_at.push_back(kNone);
    if (path) piece_.line_edges.divide(a, b, v, *path);
    new_walls_.clear();
    for (const Piece::WallAt& w : walls_) {
      new_walls_.push_back({{a, v, w.tip}, w.wall});
      new_walls_.push_back({{v, b, w.tip}, w.wall});
    }
    piece_.replace(ring_.tets, fresh_, new_walls_);
    return true;
  }

  Piece& piece_;
  const Guide& guide_;
  bool mends_;
  double shortest_;
  std::array<std::vector<TetIndex>, kLevels> waiting_;
  FlatSet<Edge> refused_;
  EdgeRing ring_;
  std::vector<Piece::WallAt> walls_;
  std::vector<Piece::NewTet> fresh_;
  std::vector<Piece::NewWall> new_walls_;
  int steps_ = 0;
};

}  // namespace

PassCount split_long_edges(Piece& piece, const Guide& guide, std::size_t most_vertices, double shortest) {
  return Splitter(piece, guide, false, shortest).run(most_vertices);
}

PassCount split_poor(Piece& piece, const Guide& guide) {
  return Splitter(piece, guide, true, 0).mend();
}

}  // namespace octafront::adapt
