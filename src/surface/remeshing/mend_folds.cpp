
#include "surface/remeshing/mend_folds.h"

#include "base/core/disjoint_sets.h"
#include "base/core/elementary.h"
#include "base/core/parallel.h"
#include "base/geometry/measures.h"
#include "base/geometry/predicates.h"
#include "surface/edits/line_edits.h"
#include "surface/lines/seams.h"

#include <algorithm>
#include <numbers>
#include <queue>

namespace octafront::surface {

namespace {

constexpr double kDegree = std::numbers::pi / 180;
/// Edges sharper than this, on either side, are folds.
constexpr double kFold = 25 * kDegree;
/// How sharp an edge must be for the surface to move by so much of what is allowed. Machine parts have true wedges of
/// 19 to 25 degrees, which large moves would open.
struct Tier {
  double angle, move;
};
constexpr Tier kTiers[] = {{kFold, 0.25}, {15 * kDegree, 1}, {14 * kDegree, 2}};
/// What an operation must take away around a place to be worth it: radians of folding, or 2r/R of bad triangles.
constexpr double kGainOfMending = 0.01;
/// What a pair of triangles that cross counts.
constexpr double kCrossing = 1;
/// No new triangle is worse than this 2r/R, unless one was, where no limit is given.
constexpr double kLeastShape = 0.02;
/// Parts of the way to the mean of its neighbours that a vertex is tried at.
constexpr double kPartsOfWay[] = {1, 0.5, 0.25};
/// And, if it crosses, of the ways to each of these and away from it.
constexpr double kCrossingSteps[] = {0.5, 0.25, -0.25};
/// Operations per place at most, on average: others may spring up beside one that is mended.
constexpr std::size_t kOperationsPerPlace = 8;
/// An edge longer than this many times the move allowed cannot collapse within it.
constexpr double kLongestToCollapse = 20;
/// Larger stars are left alone, for what judging a change of one takes grows with its square: tips of needles between
/// kept triangles have hundreds of triangles, all of them bad, and no change helps there.
constexpr std::size_t kLargestStar = 32;
/// Triangles or half-edges that one thread looks through at a time.
constexpr std::size_t kRangeOfFolds = 8192;

/// What may be done.
struct Change {
  enum class Kind { kNone, kFlip, kCollapse, kMove, kSplit };
  Kind kind = Kind::kNone;
  HalfEdge half_edge = kNone;
  Vec3 place{};                ///< of kMove: where the start of half_edge goes; of kSplit: the new vertex
  std::uint32_t face = kNone;  ///< the triangle of `onto` that the place lies in
  double badness = 0;          ///< how much more there is of it afterwards
  double move = 0;
  double moved = 0;  ///< with what was done to these triangles before
};

double distance_to(Vec3 p, const std::vector<TriangleCorners>& triangles) {
  double least = HUGE_VAL;
  for (const auto& [a, b, c] : triangles)
    least = std::min(least, squared_distance(p, closest_point_on_triangle(p, a, b, c)));
  return std::sqrt(least);
}

/// How far the first triangles lie from the others, at their corners, middles of edges and centroids; nobody asks how
/// much farther than the limit.
double farthest(const std::vector<TriangleCorners>& from, const std::vector<TriangleCorners>& to, double limit) {
  double most = 0;
  for (const auto& [a, b, c] : from) {
    for (const Vec3 p : {a, b, c, (a + b) * 0.5, (b + c) * 0.5, (c + a) * 0.5, centroid(a, b, c)}) {
      most = std::max(most, distance_to(p, to));
      if (most > limit) return most;
    }
  }
  return most;
}

/// Between two triangles at their common edge, from 0 (folded) to pi (flat), whichever way it bends.
double opening(Vec3 n, Vec3 m) {
  return std::numbers::pi - elementary::atan2(length(cross(n, m)), dot(n, m));
}

double folding(Vec3 n, Vec3 m) {
  if (dot(n, m) >= 0) return 0;  // a right angle at least, as nearly all are
  return std::max(0.0, kFold - opening(n, m));
}

/// What stays fixed: what was, and rims of holes and handles that are smaller than what may move. Collapses around one
/// cannot end in a point, and half of them leave a tangle: edges so short are joined, and what then has a line around a
/// hole (an Euler characteristic of 0) keeps its corners. More holes in one are noise, and vertices of round rims may
/// go.
std::vector<std::uint8_t> with_small_rims(const WorkingMesh& mesh, const FoldLimits& limits) {
  std::vector<std::uint8_t> fixed = limits.is_fixed;
  if (limits.size_part == 0) return fixed;
  fixed.resize(mesh.points.size(), 0);
  const auto is_short = [&](HalfEdge h) {
    const VertexIndex v = mesh.start[h], w = mesh.end(h);
    const double most = std::min(limits.tolerance, limits.size_part * std::min(mesh.size[v], mesh.size[w]));
    return squared_length(mesh.points[v] - mesh.points[w]) < most * most;
  };
  const std::vector<HalfEdge> short_ones = parallel_select(
      mesh.start.size(), [&](HalfEdge h) { return !mesh.is_removed(h / 3) && is_short(h); }, kRangeOfFolds);
  if (short_ones.empty()) return fixed;
  DisjointSets joined(mesh.points.size());
  for (const HalfEdge h : short_ones) joined.join(mesh.start[h], mesh.end(h));
  std::vector<int> euler(mesh.points.size(), 0);  // by the least vertex
  std::vector<std::uint8_t> is_counted(mesh.points.size(), 0);
  for (const HalfEdge h : short_ones) {
    int& sum = euler[joined.find(mesh.start[h])];
    for (const VertexIndex v : {mesh.start[h], mesh.end(h)}) sum += is_counted[v] == 0, is_counted[v] = 1;
    sum -= h < mesh.twin[h];
    sum += h % 3 == 0 && is_short(h + 1) && is_short(h + 2);
  }
  for (VertexIndex v = 0; v < mesh.points.size(); ++v)
    if (is_counted[v] != 0 && mesh.kind[v] == VertexKind::kCorner && euler[joined.find(v)] == 0) fixed[v] = 1;
  return fixed;
}

/// Whether a new edge would run between two vertices on seams: it may be there in another part.
bool joins_seams(const WorkingMesh& mesh, HalfEdge h) {
  const VertexIndex w = mesh.end(h), a = mesh.apex(h), b = mesh.apex(mesh.twin[h]);
  bool found = false;
  mesh.for_each_outgoing(mesh.start[h], [&](HalfEdge o) {
    const VertexIndex v = mesh.end(o);
    found = found || (v != w && v != a && v != b && mesh.is_sewn(v));
  });
  return found;
}

/// The point of what is stood for that is nearest to p; of a complex, if there is one of the triangle's own patch no
/// farther than it may move: beside seams others may be nearer.
TriangleTree::Nearest nearest_in_patch(const FoldLimits& limits, Vec3 p, std::uint32_t patch, double reach) {
  const TriangleTree::Nearest any = limits.onto->nearest(p);
  if (limits.patch_of == nullptr || (*limits.patch_of)[any.triangle] == patch) return any;
  TriangleTree::Nearest best{{}, kNone, reach * reach};
  const Vec3 r{reach, reach, reach};
  limits.onto->for_each_box_near({p - r, p + r}, [&](std::uint32_t face, const TriangleCorners& c) {
    if ((*limits.patch_of)[face] != patch) return true;
    const Vec3 q = closest_point_on_triangle(p, c[0], c[1], c[2]);
    const double d = squared_distance(p, q);
    if (d < best.squared_distance) best = {q, face, d};
    return true;
  });
  return best;
}

bool shapes_are_fair(const std::vector<TriangleCorners>& before, const std::vector<TriangleCorners>& after,
                     double least_shape) {
  const auto worst = [](const std::vector<TriangleCorners>& triangles) {
    double least = 1;
    for (const auto& [a, b, c] : triangles) least = std::min(least, triangle_radius_ratio(a, b, c));
    return least;
  };
  const double limit = least_shape > 0 ? least_shape : kLeastShape;
  return worst(after) >= std::min(limit, worst(before));
}

class FoldMender {
 public:
  FoldMender(WorkingMesh& mesh, const FoldLimits& limits)
      : mesh_(mesh),
        limits_(limits),
        is_fixed_(with_small_rims(mesh, limits)),
        edits_(mesh, is_fixed_),
        sewn_(mesh),
        live_(sewn_) {
    if (limits.crossing) crosses_ = *limits.crossing;
    crosses_.resize(mesh.triangle_count(), 0);
    result_.moved.resize(mesh.triangle_count(), 0);
  }

  MendedFolds run(const RunContext& context) {
    queue_ = Queue({}, bad_triangles());
    const std::size_t most = kOperationsPerPlace * queue_.size() + 100;
    while (!queue_.empty() && result_.operations < most && result_.judged < limits_.most_judged) {
      context.check();
      const auto [badness, t] = queue_.top();
      queue_.pop();
      if (mesh_.is_removed(t) || badness_of(t) != badness) continue;
      if (crosses_[t] && !still_crosses(t)) {
        crosses_[t] = 0;
        push(t);
        continue;
      }
      mend(t);
    }
    result_.folds_left = parallel_sum(mesh_.start.size(), [&](std::size_t begin, std::size_t end) {
      std::uint64_t folds = 0;
      for (auto h = static_cast<HalfEdge>(begin); h < end; ++h)
        folds += mesh_.start[h] != kNone && h < mesh_.twin[h] && folding_at(h) > 0;
      return folds;
    });
    return result_;
  }

 private:
  using Queue = std::priority_queue<std::pair<double, std::uint32_t>>;

  /// With how bad they are.
  std::vector<std::pair<double, std::uint32_t>> bad_triangles() const {
    return parallel_collect<std::pair<double, std::uint32_t>>(
        mesh_.triangle_count(), kRangeOfFolds, [&](std::size_t begin, std::size_t end, auto& found) {
          for (auto t = static_cast<std::uint32_t>(begin); t < end; ++t) {
            if (mesh_.is_removed(t) || mesh_.is_back(t)) continue;
            if (const double badness = badness_of(t); badness > 0) found.emplace_back(badness, t);
          }
        });
  }

  bool is_kept_line(HalfEdge h) const { return limits_.keep_lines && mesh_.is_feature[h]; }
  double folding_at(HalfEdge h) const {
    return is_kept_line(h) ? 0 : folding(mesh_.area_vector(h / 3), mesh_.area_vector(mesh_.twin[h] / 3));
  }
  TriangleCorners corners(std::uint32_t t) const { return live_.corners(t); }
  double shape_lack(const TriangleCorners& t) const {
    if (limits_.least_shape == 0) return 0;
    return std::max(0.0, limits_.least_shape - triangle_radius_ratio(t[0], t[1], t[2]));
  }
  double badness_of(std::uint32_t t) const {
    return crosses_[t] * kCrossing + shape_lack(corners(t)) + folding_at(3 * t) + folding_at(3 * t + 1) +
           folding_at(3 * t + 2);
  }

  void push(std::uint32_t t) {
    if (mesh_.is_removed(t) || mesh_.is_back(t)) return;
    const double badness = badness_of(t);
    if (badness > 0) queue_.push({badness, t});
  }

  double allowed_at(std::uint32_t t) const {
    if (limits_.size_part == 0) return limits_.tolerance;
    return std::min(limits_.tolerance, limits_.size_part * mesh_.size[mesh_.start[3 * t]]);
  }

  /// Does what leaves the least badness around the triangle.
  void mend(std::uint32_t t) {
    double most_folded = 0;
    for (HalfEdge h = 3 * t; h < 3 * t + 3; ++h) most_folded = std::max(most_folded, folding_at(h));
    for (const Tier& tier : kTiers) {
      if (most_folded <= kFold - tier.angle && shape_lack(corners(t)) == 0 && !crosses_[t]) return;
      best_ = {};
      limit_ = std::min(limits_.tolerance, tier.move * allowed_at(t));
      if (crosses_[t])
        limit_ =
            std::max(limit_, std::min(limits_.crossing_part * mesh_.size[mesh_.start[3 * t]], limits_.crossing_most));
      if (limits_.leeway)
        for (const Vec3 p : corners(t)) limit_ = limits_.leeway->at(p, limit_);
      for (HalfEdge h = 3 * t; h < 3 * t + 3; ++h) {
        const HalfEdge g = mesh_.twin[h];
        for (const HalfEdge e : {h, next_of(g), previous_of(g)}) {
          for (const HalfEdge side : {e, mesh_.twin[e]}) {
            consider_flip(side);
            consider_collapse(side);
          }
        }
        consider_moves(h);
        consider_moves(previous_of(g));
        if (crosses_[t]) consider_split(h);
      }
      if (best_.kind == Change::Kind::kNone) continue;
      apply();
      return;
    }
  }

  void consider_flip(HalfEdge h) {
    if (!mesh_.is_feature[h] && h > mesh_.twin[h]) return;  // the same either way
    if (!edits_.may_flip(h)) return;
    const HalfEdge g = mesh_.twin[h];
    old_.assign({h / 3, g / 3});
    const VertexIndex a = mesh_.start[h], b = mesh_.start[g], c = mesh_.apex(h), d = mesh_.apex(g);
    if (mesh_.is_sewn(c) && mesh_.is_sewn(d)) return;
    new_.clear();
    for (const Triangle& t : {Triangle{a, d, c}, Triangle{b, c, d}})
      new_.push_back({t, {mesh_.points[t[0]], mesh_.points[t[1]], mesh_.points[t[2]]}});
    is_line_.assign(2, {});
    is_line_[0][2] = is_line_[1][0] = is_kept_line(h);
    judge({Change::Kind::kFlip, h}, kNone);
  }

  void consider_collapse(HalfEdge h) {
    const VertexIndex u = mesh_.start[h], w = mesh_.end(h);
    if (distance(mesh_.points[u], mesh_.points[w]) > kLongestToCollapse * limit_ || !edits_.may_collapse(h)) return;
    if (mesh_.is_sewn(w) && joins_seams(mesh_, h)) return;
    gather_star(u, mesh_.points[w], w);
    judge({Change::Kind::kCollapse, h}, w);
  }

  void consider_moves(HalfEdge at) {
    const VertexIndex v = mesh_.start[at];
    if (mesh_.on_curve(v) || edits_.must_stay(v)) return;
    const Vec3 p = mesh_.points[v];
    Vec3 sum;
    std::vector<Vec3> ring;
    mesh_.for_each_outgoing(v, [&](HalfEdge h) { ring.push_back(mesh_.points[mesh_.end(h)]); });
    for (const Vec3 q : ring) sum += q;
    for (const double step : kPartsOfWay) consider_move(at, p + (sum / static_cast<double>(ring.size()) - p) * step);
    if (!crosses_[at / 3] || limits_.crossing_part == 0) return;
    for (const Vec3 q : ring)
      for (const double step : kCrossingSteps) consider_move(at, p + (q - p) * step);
  }

  void consider_move(HalfEdge at, Vec3 to) {
    Change change{Change::Kind::kMove, at, to};
    if (limits_.onto) {
      const TriangleTree::Nearest nearest = nearest_in_patch(limits_, to, mesh_.patch[at / 3], limit_);
      if (nearest.triangle == kNone) return;
      change.place = nearest.point;
      change.face = nearest.triangle;
    }
    gather_star(mesh_.start[at], change.place, kNone);
    judge(change, kNone);
  }

  /// A vertex on the middle of an edge, put on the surface that is stood for: chords of a sheet come nearer to it.
  void consider_split(HalfEdge h) {
    if (mesh_.is_feature[h] || !limits_.onto) return;
    const HalfEdge g = mesh_.twin[h];
    const VertexIndex a = mesh_.start[h], b = mesh_.start[g], c = mesh_.apex(h), d = mesh_.apex(g);
    const TriangleTree::Nearest middle =
        nearest_in_patch(limits_, (mesh_.points[a] + mesh_.points[b]) * 0.5, mesh_.patch[h / 3], limit_);
    if (middle.triangle == kNone) return;
    const auto x = static_cast<VertexIndex>(mesh_.points.size());
    old_.assign({h / 3, g / 3});
    new_.clear();
    for (const auto& [p, q] : {Edge{c, a}, Edge{b, c}, Edge{a, d}, Edge{d, b}})
      new_.push_back({{p, q, x}, {mesh_.points[p], mesh_.points[q], middle.point}});
    is_line_.assign(new_.size(), {});
    judge({Change::Kind::kSplit, h, middle.point, middle.triangle}, kNone);
  }

  /// The triangles around v, and what they are with v at p; as the vertex w if that is one.
  void gather_star(VertexIndex v, Vec3 p, VertexIndex w) {
    old_.clear();
    new_.clear();
    is_line_.clear();
    mesh_.for_each_outgoing(v, [&](HalfEdge o) {
      old_.push_back(o / 3);
      const VertexIndex a = mesh_.end(o), b = mesh_.apex(o);
      if (a == w || b == w) return;
      new_.push_back({{w == kNone ? v : w, a, b}, {p, mesh_.points[a], mesh_.points[b]}});
      is_line_.push_back({is_kept_line(o), false, is_kept_line(previous_of(o))});
    });
  }

  /// Remembers the change if it is better than any so far, moves the surface little, and makes crossings fewer, or none
  /// where there are none.
  void judge(Change change, VertexIndex merged) {
    if (old_.size() > kLargestStar) return;
    ++result_.judged;
    const auto after = badness_after(merged, mesh_.start[change.half_edge]);
    if (!after) return;
    const double to_beat = best_.kind == Change::Kind::kNone ? -kGainOfMending : best_.badness;
    const bool any_crossing = std::any_of(old_.begin(), old_.end(), [&](std::uint32_t t) { return crosses_[t] != 0; });
    change.badness = *after - badness_before();
    if (!any_crossing && !(change.badness < to_beat)) return;
    old_corners_.clear();
    new_corners_.clear();
    for (const std::uint32_t t : old_) old_corners_.push_back(corners(t));
    for (const IdTriangle& t : new_) new_corners_.push_back(t.corners);
    if (!shapes_are_fair(old_corners_, new_corners_, limits_.least_shape)) return;
    change.move = farthest(old_corners_, new_corners_, limit_);
    if (change.move > limit_) return;
    change.move = std::max(change.move, farthest(new_corners_, old_corners_, limit_));
    if (change.move > limit_) return;
    change.moved = change.move + moved_so_far();
    if (change.moved > limits_.total) return;
    // Searched last, for that takes the longest.
    const int crossings = any_crossing ? live_.crossings_among(old_) : 0;
    change.badness -= kCrossing * crossings;
    if (!(change.badness < to_beat)) return;
    sewn_new_.clear();
    for (const IdTriangle& t : new_) sewn_new_.push_back(sewn_.sewn(t));
    const int left = live_.crossings_among(sewn_new_, old_, std::max(1, crossings));
    change.badness += kCrossing * left;
    if (left > 0 && left >= crossings) return;
    if (change.badness < to_beat) best_ = change;
  }

  double moved_so_far() const {
    double most = 0;
    for (const std::uint32_t t : old_) most = std::max(most, result_.moved[t]);
    return most;
  }

  bool is_old(std::uint32_t t) const { return std::find(old_.begin(), old_.end(), t) != old_.end(); }

  double badness_before() const {
    double sum = 0;
    for (const std::uint32_t t : old_) {
      sum += shape_lack(corners(t));
      for (HalfEdge h = 3 * t; h < 3 * t + 3; ++h) sum += folding_at(h) * (is_old(mesh_.twin[h] / 3) ? 0.5 : 1);
    }
    return sum;
  }

  /// nullopt if a triangle has no area then.
  std::optional<double> badness_after(VertexIndex merged, VertexIndex gone) {
    double sum = 0;
    gather_sides(merged, gone);
    for (std::size_t k = 0; k < new_.size(); ++k) {
      const IdTriangle& t = new_[k];
      const auto& [a, b, c] = t.corners;
      if (collinear(a, b, c)) return std::nullopt;
      sum += shape_lack(t.corners);
      for (int i = 0; i < 3; ++i)
        sides_.push_back({t.ids[i], t.ids[(i + 1) % 3], double_area_normal(a, b, c), false, is_line_[k][i] != 0});
    }
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      for (std::size_t j = i + 1; j < sides_.size(); ++j) {
        const bool is_pair = sides_[i].from == sides_[j].to && sides_[i].to == sides_[j].from;
        if (is_pair && !(sides_[i].is_outside && sides_[j].is_outside) && !sides_[i].is_line && !sides_[j].is_line)
          sum += folding(sides_[i].normal, sides_[j].normal);
      }
    }
    return sum;
  }

  /// The triangles around the old ones, by the edges that they have in common.
  void gather_sides(VertexIndex merged, VertexIndex gone) {
    const auto renamed = [&](VertexIndex v) { return merged != kNone && v == gone ? merged : v; };
    sides_.clear();
    for (const std::uint32_t t : old_) {
      for (HalfEdge h = 3 * t; h < 3 * t + 3; ++h) {
        const HalfEdge g = mesh_.twin[h];
        if (is_old(g / 3)) continue;
        sides_.push_back(
            {renamed(mesh_.start[g]), renamed(mesh_.end(g)), mesh_.area_vector(g / 3), true, is_kept_line(g)});
      }
    }
  }

  bool still_crosses(std::uint32_t t) {
    old_.assign({t});
    if (LiveTriangles<SewnMesh>::is_degenerate(corners(t))) return true;
    return live_.crossings({sewn_.triangle(t), corners(t)}, old_, 1) > 0;
  }

  void apply() {
    const HalfEdge h = best_.half_edge;
    const VertexIndex v = mesh_.start[h];
    std::vector<std::uint32_t> touched{h / 3, mesh_.twin[h] / 3};
    if (best_.kind == Change::Kind::kCollapse || best_.kind == Change::Kind::kMove)
      mesh_.for_each_outgoing(v, [&](HalfEdge o) { touched.push_back(o / 3); });
    if (best_.kind == Change::Kind::kFlip) edits_.flip(h);
    if (best_.kind == Change::Kind::kCollapse) edits_.collapse(h);
    if (best_.kind == Change::Kind::kSplit) {
      const double size = 0.5 * (mesh_.size[v] + mesh_.size[mesh_.end(h)]);
      const VertexIndex x = mesh_.add_vertex(best_.place, VertexKind::kFree, {}, size, best_.face);
      mesh_.split_edge(h, x);
      mesh_.for_each_outgoing(x, [&](HalfEdge o) { touched.push_back(o / 3); });
      crosses_.resize(mesh_.triangle_count(), 0);
      result_.moved.resize(mesh_.triangle_count(), 0);
    }
    if (best_.kind == Change::Kind::kMove) {
      mesh_.points[v] = best_.place;
      if (best_.face != kNone) mesh_.face[v] = best_.face;
      mesh_.mark_star_changed(v);
    }
    note_changed(touched);
    for (const std::uint32_t t : touched) result_.moved[t] = std::max(result_.moved[t], best_.moved);
    ++result_.operations;
    result_.largest_move = std::max(result_.largest_move, best_.moved);
  }

  void note_changed(const std::vector<std::uint32_t>& touched) {
    live_.note_changed(touched);
    const bool had_crossing =
        std::any_of(touched.begin(), touched.end(), [&](std::uint32_t t) { return crosses_[t] != 0; });
    for (const std::uint32_t t : touched) {
      crosses_[t] = had_crossing && !mesh_.is_removed(t) && still_crosses(t);
    }
    for (const std::uint32_t t : touched) {
      push(t);
      if (mesh_.is_removed(t)) continue;
      for (HalfEdge h = 3 * t; h < 3 * t + 3; ++h) push(mesh_.twin[h] / 3);
    }
  }

  struct Side {
    VertexIndex from, to;
    Vec3 normal;
    bool is_outside, is_line;
  };

  WorkingMesh& mesh_;
  const FoldLimits& limits_;
  const std::vector<std::uint8_t> is_fixed_;
  LineEdits edits_;
  const SewnMesh sewn_;
  LiveTriangles<SewnMesh> live_;
  std::vector<std::uint8_t> crosses_;  ///< per triangle
  Queue queue_;
  MendedFolds result_;
  double limit_ = 0;
  Change best_;
  std::vector<std::uint32_t> old_;
  std::vector<IdTriangle> new_, sewn_new_;
  std::vector<std::array<std::uint8_t, 3>> is_line_;  ///< per new triangle and edge, from corner i to the next
  std::vector<TriangleCorners> old_corners_, new_corners_;
  std::vector<Side> sides_;
};

}  // namespace

MendedFolds mend_folds(WorkingMesh& mesh, const FoldLimits& limits, const RunContext& context) {
  return FoldMender(mesh, limits).run(context);
}

}  // namespace octafront::surface
