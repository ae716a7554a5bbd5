// Collapses of edges: one end goes to the other, the tets around the edge vanish.

#include "adapt/passes/metric_passes.h"
#include "adapt/passes/worth.h"
#include "base/mesh/link_condition.h"

#include <algorithm>

namespace octafront::adapt {
namespace {

/// An element that collapse makes has at least this score, or the worst one of those before: where a metric turns,
/// what is short goes by way of poor elements, or not at all.
constexpr float kLeastOfCollapse = 0.3f, kLeastOfCollapseInMetric = 0.1f;
/// No edge that collapse makes is longer than this.
constexpr double kLongestOfCollapse = kLongest;
/// Edges of elements of a lower score go too, where that makes the place better by so much.
constexpr float kPoorForCollapse = 0.3f, kPoorForCollapseInMetric = 0.55f, kGainOfPoor = 1.1f;
constexpr int kMostRounds = 3;
constexpr int kCheckCollapseEvery = 256;

class EdgeCollapser {
 public:
  EdgeCollapser(Piece& piece, const Guide& guide, bool mends) : piece_(piece), guide_(guide), mends_(mends) {}

  PassCount run() {
    PassCount sum;
    for (int round = 0; round < kMostRounds; ++round) {
      const PassCount count = sweep(round);
      sum += count;
      if (count.done == 0) break;
    }
    return sum;
  }

 private:
  struct Short {
    double length;
    Edge edge;
    TetIndex tet;

    std::uint64_t key() const { return std::uint64_t{edge[0]} << 32 | edge[1]; }
  };
  /// One end at the other: what comes of it.
  struct Plan {
    VertexIndex gone = kNone, onto = kNone;
    float worst = 0;
    bool is_behind = false;  ///< it is not better than another one, and was not finished
    std::vector<TetIndex> old;
    std::vector<Piece::NewTet> fresh;
    std::vector<Piece::NewWall> walls;

    void clear() {
      gone = onto = kNone, worst = 0, is_behind = false;
      old.clear(), fresh.clear(), walls.clear();
    }
  };

  PassCount sweep(int round) {
    PassCount count;
    const std::vector<Short> edges = short_edges(round);
    for (const Short& s : edges) {
      if (++steps_ % kCheckCollapseEvery == 0) guide_.context.check();
      const TetIndex t = piece_.tet_with(s.edge[0], s.edge[1], s.tet);
      if (t == kNone) continue;
      ++count.tried;
      if (!collapse(t, s.edge[0], s.edge[1])) continue;
      ++count.done;
      for (const TetIndex made : piece_.created())
        for (const VertexIndex v : piece_.tet(made)) changed_[v] = round + 1;
    }
    return count;
  }

  /// Edges that are too short; in later rounds those where the round before changed something.
  std::vector<Short> short_edges(int round) {
    std::vector<Short> found;
    changed_.resize(piece_.vertices.size(), 0);
    seen_.resize(piece_.vertices.size(), 0);
    const auto waits = [&](VertexIndex v) {
      return round == 0 ? mends_ || piece_.vertices[v].active : changed_[v] == round;
    };
    const float poor = piece_.isotropic ? kPoorForCollapse : kPoorForCollapseInMetric;
    worst_at_.assign(piece_.vertices.size(), poor);
    for (TetIndex t = 0; t < piece_.complex.slots(); ++t)
      if (piece_.score[t] < poor && piece_.complex.alive(t))
        for (const VertexIndex v : piece_.tet(t)) worst_at_[v] = std::min(worst_at_[v], piece_.score[t]);
    for (TetIndex t = 0; t < piece_.complex.slots(); ++t) {
      if (!piece_.complex.alive(t)) continue;
      const Tet& c = piece_.tet(t);
      if (std::none_of(c.begin(), c.end(), waits)) continue;
      const bool goes = mends_ ? is_to_mend(piece_, t) : piece_.score[t] < poor;
      if (mends_ && !goes) continue;
      for (const auto& [i, j] : kTetEdges) {
        const Vertex &p = piece_.vertices[c[i]], &q = piece_.vertices[c[j]];
        if (!(waits(c[i]) || waits(c[j])) || (p.stays() && q.stays())) continue;
        // Around others there is one that is poorer, and asks by itself.
        const float score = piece_.score[t];
        const bool helps = goes && (mends_ || worst_at_[c[i]] == score || worst_at_[c[j]] == score);
        if (!helps && squared_bounds(p, q, piece_.isotropic).surely_beyond(kShortest)) continue;
        const double l = piece_.edge_length(c[i], c[j]);
        if (l < kShortest || helps) found.push_back({l, sorted_edge(c[i], c[j]), t});
      }
    }
    const auto before = [](const Short& a, const Short& b) {
      if (a.length != b.length) return a.length < b.length;
      return a.key() != b.key() ? a.key() < b.key() : a.tet < b.tet;
    };
    std::sort(found.begin(), found.end(), before);
    found.erase(
        std::unique(found.begin(), found.end(), [](const Short& a, const Short& b) { return a.key() == b.key(); }),
        found.end());
    return found;
  }

  bool collapse(TetIndex t, VertexIndex a, VertexIndex b) {
    if (!piece_.ring(t, a, b, ring_)) return false;
    one_.clear(), other_.clear();
    if (!piece_.vertices[a].stays()) plan(a, b, one_);
    if (!piece_.vertices[b].stays()) plan(b, a, other_, one_.worst);
    const bool first = !(other_.worst > one_.worst);
    for (Plan* plan : {first ? &one_ : &other_, first ? &other_ : &one_}) {
      if (plan->is_behind) plan_again(*plan);
      if (!(plan->worst > 0) || !keeps_surface(*plan)) continue;
      apply(*plan);
      return true;
    }
    return false;
  }

  /// Whether the vertex may go to the other end as far as walls and lines are concerned.
  bool kinds_allow(VertexIndex u, VertexIndex w) {
    const Vertex &from = piece_.vertices[u], &to = piece_.vertices[w];
    switch (from.kind) {
      case Kind::kInner:
        return true;
      case Kind::kCurve: {
        const std::uint32_t* path = piece_.line(u, w);
        return path && *path != Parts::kStays && !to.rim;
      }
      case Kind::kSurface:
        if (to.kind == Kind::kInner || to.rim) return false;
        piece_.walls_of(u, w, ring_, walls_at_);
        return walls_at_.size() == 2;
      default:
        return false;
    }
  }

  /// `rival`: what is not worse than that alone is finished.
  void plan(VertexIndex u, VertexIndex w, Plan& out, float rival = 0) {
    if (!kinds_allow(u, w)) return;
    out.gone = u, out.onto = w;
    if (!plan_tets(out, rival)) out.worst = 0;
  }
  void plan_again(Plan& out) {
    const VertexIndex u = out.gone, w = out.onto;
    out.clear();
    plan(u, w, out);
  }
  bool keeps_surface(Plan& out) {
    return piece_.vertices[out.gone].kind == Kind::kInner || (keeps_manifold(out.gone, out.onto) && plan_walls(out));
  }

  bool plan_tets(Plan& out, float rival) {
    if (!mends_ && is_too_far(out)) return false;
    const std::vector<TetIndex>& star = piece_.star(out.gone);
    out.old.assign(star.begin(), star.end());
    float had = 1;
    for (const TetIndex t : out.old) had = std::min(had, mends_ ? worth_of(piece_, piece_.tet(t)) : piece_.score[t]);
    if (!mends_ && !lengths_allow(out)) return false;
    const bool is_short = !mends_ && piece_.is_shorter(piece_.vertices[out.gone], piece_.vertices[out.onto], kShortest);
    const float least =
        is_short ? std::min(had, piece_.isotropic ? kLeastOfCollapse : kLeastOfCollapseInMetric) : kGainOfPoor * had;
    out.worst = 1;
    for (const TetIndex t : out.old) {
      if (piece_.complex.has(t, out.onto)) continue;
      Tet c = piece_.tet(t);
      std::replace(c.begin(), c.end(), out.gone, out.onto);
      const float s = piece_.score_of(c);
      const float value = mends_ && s > 0 ? worth_of(piece_, c) : s;
      if (!(value >= least) || !(s > 0)) return false;
      if (value <= rival) {
        out.is_behind = true;
        return false;
      }
      out.worst = std::min(out.worst, value);
      out.fresh.push_back({c, piece_.region[t], s});
    }
    return !out.fresh.empty();
  }

  bool is_long(VertexIndex from, VertexIndex to) const { return piece_.is_longer(from, to, kLongestOfCollapse); }

  /// Whether the vertices behind the ring tell already that lengths do not allow it: most often they do, without the
  /// star.
  bool is_too_far(const Plan& plan) const {
    bool is_far = false;
    for (const TetIndex t : ring_.tets) {
      const HalfFace o = piece_.complex.across[piece_.complex.opposite(t, plan.onto)];
      if (is_outside(o)) continue;
      const VertexIndex v = piece_.complex.apex(o);
      if (is_long(plan.gone, v)) return false;
      is_far = is_far || is_long(plan.onto, v);
    }
    return is_far &&
           std::none_of(ring_.ring.begin(), ring_.ring.end(), [&](VertexIndex v) { return is_long(plan.gone, v); });
  }

  /// Whether no new edge is longer than the longest there was, or than is wanted.
  bool lengths_allow(const Plan& plan) {
    around_.clear();
    ++stamp_;
    for (const TetIndex t : plan.old)
      for (const VertexIndex v : piece_.tet(t))
        if (v != plan.gone && v != plan.onto && seen_[v] != stamp_) seen_[v] = stamp_, around_.push_back(v);
    const auto any_long = [&](VertexIndex from) {
      return std::any_of(around_.begin(), around_.end(), [&](VertexIndex v) { return is_long(from, v); });
    };
    if (!any_long(plan.onto)) return true;
    if (!any_long(plan.gone)) return false;
    const auto longest = [&](VertexIndex from) {
      double most = 0;
      for (const VertexIndex v : around_) most = std::max(most, piece_.edge_length(from, v));
      return most;
    };
    return longest(plan.onto) <= longest(plan.gone);
  }

  /// The walls at the vertex that goes, with it at its new place; false if they would not be true, or lines would
  /// merge.
  bool plan_walls(Plan& out) {
    const VertexIndex u = out.gone, w = out.onto;
    std::vector<WallTriangle> before, after;
    bool merges_lines = false;
    piece_.for_each_wall(u, out.old, [&](HalfFace h) {
      Triangle f = piece_.complex.face(h);
      before.push_back({corners_of(f), piece_.wall[h]});
      if (f[0] == w || f[1] == w || f[2] == w) {
        for (const VertexIndex x : f)
          merges_lines = merges_lines || (x != u && x != w && piece_.line(u, x) && piece_.line(w, x));
        return;
      }
      std::replace(f.begin(), f.end(), u, w);
      after.push_back({corners_of(f), piece_.wall[h]});
      out.walls.push_back({f, piece_.wall[h]});
    });
    return !merges_lines && keep_walls_true(guide_, before, after, piece_.vertices[w].near);
  }

  TriangleCorners corners_of(const Triangle& f) const {
    return {piece_.point(f[0]), piece_.point(f[1]), piece_.point(f[2])};
  }

  /// For a vertex on walls: the tets on all sides, and the walls by themselves.
  bool keeps_manifold(VertexIndex u, VertexIndex w) {
    const auto tet = [&](TetIndex t) -> const Tet& { return piece_.tet(t); };
    const auto is_wall = [&](HalfFace h) { return piece_.wall[h] != 0; };
    const auto faces_behind = [&](VertexIndex v) -> std::span<const HalfFace> {
      star_.clear();
      for (const TetIndex t : piece_.star(v)) star_.push_back(piece_.complex.opposite(t, v));
      return star_;
    };
    const VertexLink of_w = link_of(faces_behind(w), tet, is_wall), of_u = link_of(faces_behind(u), tet, is_wall);
    return may_contract(of_u, of_w, link_of(star_, tet, is_wall, w));
  }

  void apply(const Plan& p) {
    const VertexIndex u = p.gone, w = p.onto;
    if (piece_.vertices[u].kind == Kind::kCurve) {
      std::vector<VertexIndex> beside;
      for (const TetIndex t : p.old)
        for (const VertexIndex v : piece_.tet(t))
          if (v != u && piece_.line(u, v)) beside.push_back(v);
      piece_.line_edges.shorten(u, w, beside);
    }
    piece_.replace(p.old, p.fresh, p.walls);
    piece_.complex.tet_at[u] = kNone;
  }

  Piece& piece_;
  const Guide& guide_;
  bool mends_;
  EdgeRing ring_;
  std::vector<Piece::WallAt> walls_at_;
  Plan one_, other_;
  std::vector<HalfFace> star_;
  std::vector<float> worst_at_;  ///< per vertex: the least score of its elements that are poor
  std::vector<VertexIndex> around_;
  std::vector<int> changed_;         ///< per vertex: one more than the last round that changed something around it
  std::vector<std::uint32_t> seen_;  ///< per vertex: the last stamp it got
  std::uint32_t stamp_ = 0;
  int steps_ = 0;
};

}  // namespace

PassCount collapse_short_edges(Piece& piece, const Guide& guide) {
  return EdgeCollapser(piece, guide, false).run();
}

PassCount collapse_poor(Piece& piece, const Guide& guide) {
  return EdgeCollapser(piece, guide, true).run();
}

}  // namespace octafront::adapt
