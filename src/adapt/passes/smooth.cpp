// Vertices that move to where the sum of what their elements lack is least, 1 / score - 1 of each: Newton's method, a
// step for each visit, less and less of it as long as that is no gain.

#include "adapt/passes/metric_passes.h"
#include "adapt/passes/size_star.h"
#include "adapt/passes/slope.h"
#include "adapt/passes/worth.h"
#include "base/geometry/measures.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace octafront::adapt {
namespace {

constexpr int kTriesOfMove = 3;
/// What a volume is worth that is not as wanted, D + 1 / D - 2 of it: edges come nearer to their lengths. It says where
/// to go only; what is gained is judged by shapes.
constexpr double kPullOfSize = 0.1, kPullInMetric = 0.3;
/// No score falls below this, or below the least one there was.
constexpr float kGuardOfMove = 0.55f;
constexpr double kReachOfMove = 0.5;
constexpr double kLeastGainOfMove = 0.01;
constexpr int kCheckMoveEvery = 512;
/// Steps of moves that mend, in lengths of the metric: each way along its axes.
constexpr std::array<double, 3> kStepsOfMending{0.3, 0.1, 0.03};
/// Vertices that go to a given surface leave no score below this, or below this part of the least one there was, and
/// turn no wall by more (cosine); what is nearer than this part of the tolerance is there.
constexpr float kLeastOfSettle = 0.05f, kKeptOfSettle = 0.5f;
constexpr double kLeastTurnOfSettle = 0.5, kThere = 1e-3;
/// Triangles of walls turn by no more than this (cosine) against the ground, or by no more than they did.
constexpr double kLeastCosineOfWall = 0.8;

/// Whether triangles of one wall are as true to the ground as is allowed; each place is looked at once.
class WallCheck {
 public:
  /// `near`: a triangle of the ground that may be near, or kNone.
  WallCheck(const Guide& guide, Wall wall, std::uint32_t near)
      : ground_(guide.ground),
        tolerance_(guide.tolerance_of(wall)),
        part_((wall & ~kOuter) - 1),
        near_(near),
        outer_((wall & kOuter) != 0) {}

  /// Whether some may take the place of others. Edges that stay are as true as they were.
  bool allows(std::span<const TriangleCorners> before, std::span<const TriangleCorners> after) {
    before_ = before, knows_before_ = false;
    farthest_ = tolerance_, least_cosine_ = kLeastCosineOfWall;
    for (const TriangleCorners& t : before)
      for (std::size_t i = 0; i < 3; ++i) seen_.push_back(middle(t, i));
    return std::all_of(after.begin(), after.end(), [&](const TriangleCorners& t) { return is_true(t); });
  }

 private:
  static Vec3 middle(const TriangleCorners& t, std::size_t i) { return 0.5 * (t[i] + t[(i + 1) % 3]); }
  static double longest_edge(const TriangleCorners& t) { return std::sqrt(longest_squared_edge(t[0], t[1], t[2])); }

  bool is_true(const TriangleCorners& t) {
    const Vec3 normal = double_area_normal(t[0], t[1], t[2]);
    const double reach = longest_edge(t);
    const auto truth_at = [&](Vec3 p) { return ground_.truth_at(p, normal, part_, outer_, reach, near_); };
    if (!is_within(truth_at(centroid(t[0], t[1], t[2])))) return false;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 p = middle(t, i);
      if (std::find(seen_.begin(), seen_.end(), p) != seen_.end()) continue;
      seen_.push_back(p);
      if (!is_within({truth_at(p).distance, 1})) return false;
    }
    return true;
  }

  bool is_within(const Ground::Truth& has) {
    const auto is_fair = [&] { return has.distance <= farthest_ && has.cosine >= least_cosine_; };
    if (!std::isfinite(has.distance)) return false;
    if (is_fair() || knows_before_) return is_fair();
    knows_before_ = true;
    for (const TriangleCorners& t : before_) {
      const Ground::Truth had = ground_.truth_of(t, part_, outer_, longest_edge(t), near_);
      farthest_ = std::max(farthest_, had.distance), least_cosine_ = std::min(least_cosine_, had.cosine);
    }
    return is_fair();
  }

  const Ground& ground_;
  double tolerance_, farthest_ = 0, least_cosine_ = 1;
  std::uint32_t part_, near_;
  bool outer_, knows_before_ = false;
  std::span<const TriangleCorners> before_;
  std::vector<Vec3> seen_;
};

Vec3 step_along(const Slope& s, Vec3 d) {
  const double curvature = s.hessian.squared(d);
  return curvature > 0 ? -dot(s.gradient, d) / curvature * d : Vec3{};
}

Vec3 step_in_plane(const Slope& s, Vec3 n) {
  const Vec3 e = std::abs(n.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 u = normalized(e - dot(e, n) * n), w = cross(n, u);
  const double uu = s.hessian.squared(u), ww = s.hessian.squared(w), uw = dot(u, s.hessian.times(w));
  const double gu = dot(s.gradient, u), gw = dot(s.gradient, w), det = uu * ww - uw * uw;
  if (!(uu > 0 && det > 0)) return uu + ww > 0 ? -1 / (uu + ww) * (gu * u + gw * w) : Vec3{};
  return -1 / det * ((ww * gu - uw * gw) * u + (uu * gw - uw * gu) * w);
}

class VertexMover {
 public:
  VertexMover(Piece& piece, const Guide& guide) : piece_(piece), guide_(guide) {}

  PassCount run(float threshold) {
    PassCount count;
    std::vector<std::uint8_t> wanted(piece_.vertices.size(), 0);
    for (TetIndex t = 0; t < piece_.complex.slots(); ++t)
      if (piece_.complex.alive(t) && piece_.score[t] < threshold)
        for (const VertexIndex v : piece_.tet(t)) wanted[v] = 1;
    for (VertexIndex v = 0; v < wanted.size(); ++v) {
      Vertex& at = piece_.vertices[v];
      // Who comes here has been asked by all passes; what changes around it wakes it up again.
      at.active &= at.rim;
      if (!at.loose) continue;
      at.loose = at.rim;
      if (wanted[v] == 0 || at.stays()) continue;
      if (++steps_ % kCheckMoveEvery == 0) guide_.context.check();
      ++count.tried;
      count.done += move(v);
    }
    return count;
  }

  /// Moves the vertices of poor elements to where the worst element is better.
  PassCount mend() {
    PassCount count;
    for (TetIndex t = 0; t < piece_.complex.slots(); ++t)
      for (int i = 0; i < 4 && piece_.complex.alive(t) && is_to_mend(piece_, t); ++i) {
        if (++steps_ % kCheckMoveEvery == 0) guide_.context.check();
        const VertexIndex v = piece_.tet(t)[i];
        if (piece_.vertices[v].stays()) continue;
        ++count.tried;
        count.done += move_by_trial(v);
      }
    return count;
  }

  PassCount settle() {
    PassCount count;
    for (VertexIndex v = 0; v < piece_.vertices.size(); ++v) {
      const Vertex& at = piece_.vertices[v];
      if (!at.off || piece_.complex.tet_at[v] == kNone || at.rim || at.frozen || at.held || !(at.active || at.loose))
        continue;
      if (++steps_ % kCheckMoveEvery == 0) guide_.context.check();
      ++count.tried;
      count.done += settle(v);
    }
    return count;
  }

 private:
  struct WallAt {
    Triangle corners;  ///< the vertex first
    Wall wall;
  };

  /// What is around a vertex; false if it may not move.
  bool take_star(VertexIndex v, std::optional<std::uint32_t>& path) {
    const std::vector<TetIndex>& star = piece_.star(v);
    star_.assign(star.begin(), star.end());
    if (piece_.vertices[v].kind != Kind::kInner && !find_walls(v, path)) return false;
    take_cells(v);
    return true;
  }

  /// Of walls on the ground.
  bool put(Vertex& to, const std::optional<std::uint32_t>& path) {
    if (to.kind != Kind::kInner && !snap(to, path)) return false;
    to.off = false;
    return true;
  }

  bool move(VertexIndex v) {
    std::optional<std::uint32_t> path;
    if (!take_star(v, path)) return false;
    const Vertex from = piece_.vertices[v];
    float had = 1;
    double lack = 0;
    for (const TetIndex t : star_) had = std::min(had, piece_.score[t]), lack += lack_of(piece_.score[t]);
    Slope slope = slope_at(v, from);
    Vec3 step = newton_step(slope, from);
    // Half of the slope along the step is what a parabola would gain.
    if (!(-0.5 * dot(slope.gradient, step) > kLeastGainOfMove * Slope::kScale * lack)) return false;
    for (int k = 0; k < kTriesOfMove; ++k, step *= 0.5) {
      Vertex to = from;
      to.at = from.at + step;
      if (!put(to, path)) continue;
      if (!piece_.isotropic) guide_.ask(to);
      if (!is_better(to, had, lack) || !walls_stay_true(to)) continue;
      if (piece_.isotropic) guide_.ask(to);  // a size has no say in scores
      piece_.move(v, to, star_, scores_);
      return true;
    }
    return false;
  }

  bool move_by_trial(VertexIndex v) {
    std::optional<std::uint32_t> path;
    if (!take_star(v, path)) return false;
    const Vertex from = piece_.vertices[v];
    Vertex best = from;
    const float had = worst_with(from, 0);
    float worst = had;
    for (const double length : kStepsOfMending)
      for (const Vec3 step : steps_of(from, length)) {
        Vertex to = best;
        to.at = best.at + step;
        if (!put(to, path)) continue;
        guide_.ask(to);
        const float s = worst_with(to, worst);
        if (s > worst && walls_stay_true(to)) best = to, worst = s;
      }
    if (!(worst > kGainOfMending * had)) return false;
    score_at(best);
    piece_.move(v, best, star_, scores_);
    return true;
  }

  /// The worth of the worst element with the vertex there; 0 if that is not above `least`.
  float worst_with(const Vertex& to, float least) {
    float worst = HUGE_VALF;
    for (Cell& cell : cells_) {
      cell.corners[cell.at] = &to;
      worst = std::min(worst, worth_of_corners(cell.corners, piece_));
      if (!(worst > least)) return 0;
    }
    return worst;
  }

  /// Both ways along the axes of the metric, or along the line.
  std::vector<Vec3> steps_of(const Vertex& from, double length) const {
    std::vector<Vec3> steps;
    const auto add = [&](Vec3 d) {
      const double is = std::sqrt(from.metric.squared(d));
      if (is > 0) steps.push_back((length / is) * d), steps.push_back((-length / is) * d);
    };
    if (from.kind == Kind::kCurve) {
      add(piece_.point(line_ends_[1]) - piece_.point(line_ends_[0]));
      return steps;
    }
    const Vec3 n = from.kind == Kind::kSurface ? wall_normal() : Vec3{};
    for (const Vec3 axis : eigen(from.metric).vector) add(axis - dot(axis, n) * n);
    return steps;
  }

  /// A step towards the given surface; false if there is none.
  bool settle(VertexIndex v) {
    const std::vector<TetIndex>& star = piece_.star(v);
    star_.assign(star.begin(), star.end());
    const Vertex from = piece_.vertices[v];
    const auto home = home_of(v);
    if (!home || distance(*home, from.at) <= kThere * guide_.tolerance) {
      piece_.vertices[v].off = false;
      return false;
    }
    take_cells(v);
    float least = 1;
    for (const TetIndex t : star_) least = std::min(least, piece_.score[t]);
    least = std::min(kLeastOfSettle, kKeptOfSettle * least);
    for (const double share : {1.0, 0.5, 0.25}) {
      Vertex to = from;
      to.at = from.at + share * (*home - from.at);
      to.off = share != 1;
      guide_.ask(to);
      if (!all_score(to, least) || !walls_turn_little(to)) continue;
      piece_.move(v, to, star_, scores_);
      return true;
    }
    return false;
  }

  std::optional<Vec3> home_of(VertexIndex v) {
    const Vertex& from = piece_.vertices[v];
    std::optional<std::uint32_t> path;
    const bool found = find_walls(v, path);
    if (from.kind == Kind::kFixed) return guide_.ground.corner(from.id);
    Vertex to = from;
    if (!found || !snap(to, path)) return std::nullopt;
    return to.at;
  }

  bool all_score(const Vertex& to, float least) {
    score_at(to);
    return std::all_of(scores_.begin(), scores_.end(), [&](float s) { return s > least; });
  }

  bool walls_turn_little(const Vertex& to) const {
    for (const WallAt& w : walls_) {
      const Vec3 a = piece_.point(w.corners[0]), b = piece_.point(w.corners[1]), c = piece_.point(w.corners[2]);
      const Vec3 had = double_area_normal(a, b, c), has = double_area_normal(to.at, b, c);
      if (!(dot(had, has) >= kLeastTurnOfSettle * length(had) * length(has))) return false;
    }
    return true;
  }

  static double lack_of(float score) { return 1 / static_cast<double>(score) - 1; }

  /// An element of the star; the corner `at` is the vertex that moves.
  struct Cell {
    std::array<const Vertex*, 4> corners;
    int at;
  };
  void take_cells(VertexIndex v) {
    cells_.clear(), in_size_.clear();
    for (const TetIndex t : star_) {
      const Tet& c = piece_.tet(t);
      Cell cell{};
      for (int i = 0; i < 4; ++i) {
        cell.corners[i] = &piece_.vertices[c[i]];
        if (c[i] == v) cell.at = i;
      }
      cells_.push_back(cell);
      if (is_in_size())
        in_size_.add({cell.corners[0]->at, cell.corners[1]->at, cell.corners[2]->at, cell.corners[3]->at}, cell.at);
    }
  }
  bool is_in_size() const { return piece_.isotropic && star_.size() <= SizeStar::kMost; }

  /// The scores of all with the vertex there.
  void score_at(const Vertex& to) {
    scores_.clear();
    if (is_in_size()) {
      in_size_.evaluate(to.at);
      for (std::size_t k = 0; k < cells_.size(); ++k) scores_.push_back(in_size_.score(k));
      return;
    }
    for (Cell& cell : cells_) {
      cell.corners[cell.at] = &to;
      scores_.push_back(piece_.score_of_corners(cell.corners));
    }
  }

  bool is_better(const Vertex& to, float had, double lack) {
    score_at(to);
    const double most = lack * (1 - kLeastGainOfMove);
    double sum = 0;
    const float floor = std::min(had, kGuardOfMove);
    for (const float s : scores_) {
      if (!(s > 0) || s < floor) return false;
      sum += lack_of(s);
      if (!(sum < most)) return false;
    }
    return true;
  }

  Slope slope_at(VertexIndex v, const Vertex& from) {
    if (is_in_size()) return in_size_.slope_at(from.at, from.density, kPullOfSize);
    Slope slope;
    for (std::size_t k = 0; k < cells_.size(); ++k) {
      const Triangle f = piece_.complex.face(piece_.complex.opposite(star_[k], v));
      const Vec3 a = piece_.point(f[0]), b = piece_.point(f[1]), c = piece_.point(f[2]);
      const Vertex& d = densest_of(cells_[k].corners);
      slope += piece_.isotropic ? slope_of(RoundMetric{}, 1, from.density, kPullOfSize, from.at, a, b, c)
                                : slope_of(d.metric, d.density, 1, kPullInMetric, from.at, a, b, c);
    }
    return slope;
  }

  Vec3 newton_step(const Slope& slope, const Vertex& from) const {
    const Vec3 g = slope.gradient;
    if (from.kind == Kind::kCurve)
      return step_along(slope, normalized(piece_.point(line_ends_[1]) - piece_.point(line_ends_[0])));
    if (from.kind == Kind::kSurface) return step_in_plane(slope, wall_normal());
    const Metric& h = slope.hessian;
    if (!(h.xx > 0 && h.xx * h.yy > h.xy * h.xy && h.determinant() > 0)) return -1.0 / (h.xx + h.yy + h.zz) * g;
    return -inverse(h).times(g);
  }

  /// The walls at the vertex, and its line; false if it is not where it can move along them.
  bool find_walls(VertexIndex v, std::optional<std::uint32_t>& path) {
    walls_.clear(), line_ends_.clear();
    piece_.for_each_wall(v, star_, [&](HalfFace h) {
      Triangle f = piece_.complex.face(h);
      while (f[0] != v) std::rotate(f.begin(), f.begin() + 1, f.end());
      walls_.push_back({f, piece_.wall[h]});
    });
    if (piece_.vertices[v].kind != Kind::kCurve) return !walls_.empty();
    for (const TetIndex t : star_)
      for (const VertexIndex u : piece_.tet(t)) {
        const std::uint32_t* line = u == v ? nullptr : piece_.line(u, v);
        if (line && std::find(line_ends_.begin(), line_ends_.end(), u) == line_ends_.end()) {
          line_ends_.push_back(u);
          if (*line == Parts::kStays || (path && *path != *line)) return false;
          path = *line;
        }
      }
    return line_ends_.size() == 2;
  }

  Vec3 wall_normal() const {
    Vec3 sum{};
    for (const WallAt& w : walls_) {
      const Vec3 n =
          double_area_normal(piece_.point(w.corners[0]), piece_.point(w.corners[1]), piece_.point(w.corners[2]));
      sum += dot(sum, n) < 0 && (w.wall & kOuter) == 0 ? -n : n;
    }
    return normalized(sum);
  }

  bool snap(Vertex& to, const std::optional<std::uint32_t>& path) const {
    const Vec3 other = piece_.point(walls_.empty() ? line_ends_[0] : walls_[0].corners[1]);
    const double reach = kReachOfMove * distance(to.at, other);
    const auto home = path ? guide_.ground.on_line(to.at, *path, reach)
                           : guide_.ground.on_surface(to.at, (walls_[0].wall & ~kOuter) - 1,
                                                      (walls_[0].wall & kOuter) != 0, wall_normal(), reach, to.near);
    if (home) to.at = *home;
    return home.has_value();
  }

  bool walls_stay_true(const Vertex& to) const {
    for (std::size_t k = 0; k < walls_.size() && to.kind != Kind::kInner; ++k) {
      const Wall wall = walls_[k].wall;
      const auto is_same = [&](const WallAt& w) { return w.wall == wall; };
      if (std::any_of(walls_.begin(), walls_.begin() + static_cast<std::ptrdiff_t>(k), is_same)) continue;
      WallCheck check(guide_, wall, to.near);
      for (const WallAt& w : walls_) {
        const Vec3 b = piece_.point(w.corners[1]), c = piece_.point(w.corners[2]);
        const std::array<TriangleCorners, 1> before{{{piece_.point(w.corners[0]), b, c}}}, after{{{to.at, b, c}}};
        if (is_same(w) && !check.allows(before, after)) return false;
      }
    }
    return true;
  }

  Piece& piece_;
  const Guide& guide_;
  std::vector<TetIndex> star_;
  std::vector<Cell> cells_;
  SizeStar in_size_;  ///< the same, in metrics of size
  std::vector<float> scores_;
  std::vector<WallAt> walls_;
  std::vector<VertexIndex> line_ends_;
  int steps_ = 0;
};

}  // namespace

bool keeps_walls_true(const Guide& guide, std::span<const TriangleCorners> before,
                      std::span<const TriangleCorners> after, Wall wall, std::uint32_t near) {
  return WallCheck(guide, wall, near).allows(before, after);
}

bool keep_walls_true(const Guide& guide, std::span<const WallTriangle> before, std::span<const WallTriangle> after,
                     std::uint32_t near) {
  std::vector<Wall> walls;
  for (const WallTriangle& t : before)
    if (std::find(walls.begin(), walls.end(), t.wall) == walls.end()) walls.push_back(t.wall);
  const auto of_wall = [](Wall wall, std::span<const WallTriangle> all) {
    std::vector<TriangleCorners> of;
    for (const WallTriangle& t : all)
      if (t.wall == wall) of.push_back(t.corners);
    return of;
  };
  return std::all_of(walls.begin(), walls.end(), [&](Wall wall) {
    const std::vector<TriangleCorners> has = of_wall(wall, after);
    return !has.empty() && keeps_walls_true(guide, of_wall(wall, before), has, wall, near);
  });
}

PassCount settle_on_ground(Piece& piece, const Guide& guide) {
  if (!guide.ground.given()) return {};
  return VertexMover(piece, guide).settle();
}

PassCount smooth_vertices(Piece& piece, const Guide& guide, float threshold) {
  return VertexMover(piece, guide).run(threshold);
}

PassCount move_poor(Piece& piece, const Guide& guide) {
  return VertexMover(piece, guide).mend();
}

}  // namespace octafront::adapt
