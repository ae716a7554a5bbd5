// Vertices that move. Each tet around a vertex wants it where the tet would be regular with edges of length 1; the mean
// of these places, the poorer tets counting more, is tried, and less and less of the way to it (the weighted ideal
// points of M. Park's "refine").

#include "adapt/passes/passes.h"
#include "base/core/elementary.h"
#include "base/geometry/measures.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace octafront::adapt {
namespace {

constexpr int kTriesOfMove = 5;
/// Height of the regular tetrahedron of edges 1.
constexpr double kHeight = 0.81649658092772603;
/// Poorer tets than this pull no more than it does.
constexpr double kLeastWeightScore = 0.05;
/// Scores may fall to this where the sum over the star gets better.
constexpr float kGuardOfMove = 0.55f;
constexpr double kReachOfMove = 0.5;
constexpr double kLeastGainOfMove = 0.01;
constexpr int kCheckMoveEvery = 512;

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
      if (!at.active) continue;
      // Who comes here has been asked by all passes; what changes around it wakes it up again.
      at.active = at.rim;
      if (wanted[v] == 0 || at.rim || at.frozen || at.kind == Kind::kFixed) continue;
      if (++steps_ % kCheckMoveEvery == 0) guide_.context.check();
      ++count.tried;
      count.done += move(v);
    }
    return count;
  }

 private:
  struct WallAt {
    Triangle corners;  ///< the vertex first
    Wall wall;
  };

  bool move(VertexIndex v) {
    star_ = piece_.star(v);
    const Vertex from = piece_.vertices[v];
    std::optional<std::uint32_t> path;
    if (from.kind != Kind::kInner && !find_walls(v, path)) return false;
    Vec3 step = ideal(v) - from.at;
    if (from.kind == Kind::kSurface) {
      const Vec3 n = wall_normal();
      step = step - dot(step, n) * n;
    } else if (from.kind == Kind::kCurve) {
      const Vec3 d = normalized(piece_.point(line_ends_[1]) - piece_.point(line_ends_[0]));
      step = dot(step, d) * d;
    }
    float had = 1;
    double lack = 0;
    for (const TetIndex t : star_) had = std::min(had, piece_.score[t]), lack += lack_of(piece_.score[t]);
    for (int k = 0; k < kTriesOfMove; ++k, step *= 0.5) {
      Vertex to = from;
      to.at = from.at + step;
      if (from.kind != Kind::kInner && !snap(to, path)) continue;
      guide_.ask(to);
      if (!is_better(v, to, had, lack) || !walls_stay_true(to)) continue;
      piece_.move(v, to, star_, scores_);
      return true;
    }
    return false;
  }

  static double lack_of(float score) {
    const double miss = 1 - static_cast<double>(score);
    return miss * miss;
  }

  bool is_better(VertexIndex v, const Vertex& to, float had, double lack) {
    scores_.clear();
    float worst = 1;
    double sum = 0;
    const float floor = std::min(had, kGuardOfMove);
    for (const TetIndex t : star_) {
      const float s = piece_.score_with(piece_.tet(t), v, to);
      if (!(s > 0) || s < floor) return false;
      worst = std::min(worst, s), sum += lack_of(s);
      scores_.push_back(s);
    }
    return sum < lack * (1 - kLeastGainOfMove) || worst > had * 1.02f;
  }

  /// The mean of the places at which the tets around would be as wanted.
  Vec3 ideal(VertexIndex v) const {
    Vec3 sum{};
    double weights = 0;
    for (const TetIndex t : star_) {
      const Triangle f = piece_.complex.face(piece_.complex.opposite(t, v));
      const Vec3 a = piece_.point(f[0]), b = piece_.point(f[1]), c = piece_.point(f[2]);
      const Metric& m = piece_.vertices[v].metric;
      // At right angles to the face, as the metric has it: M^-1 times the plane's normal.
      const Vec3 n = -double_area_normal(a, b, c), along = inverse(m).times(n);
      const double unit = std::sqrt(dot(n, along));
      if (!(unit > 0)) continue;
      const double weight = 1 / std::max(static_cast<double>(piece_.score[t]), kLeastWeightScore);
      sum += weight * (centroid(a, b, c) + (kHeight / unit) * along);
      weights += weight;
    }
    return weights > 0 ? sum / weights : piece_.point(v);
  }

  /// The walls at the vertex, and its line; false if it is not where it can move along them.
  bool find_walls(VertexIndex v, std::optional<std::uint32_t>& path) {
    walls_.clear(), line_ends_.clear();
    for (const TetIndex t : star_) {
      for (HalfFace h = 4 * t; h < 4 * t + 4; ++h) {
        if (piece_.wall[h] == 0 || piece_.complex.apex(h) == v) continue;
        if (!is_outside(piece_.complex.across[h]) && piece_.complex.across[h] < h) continue;
        Triangle f = piece_.complex.face(h);
        while (f[0] != v) std::rotate(f.begin(), f.begin() + 1, f.end());
        walls_.push_back({f, piece_.wall[h]});
      }
      if (piece_.vertices[v].kind != Kind::kCurve) continue;
      for (const VertexIndex u : piece_.tet(t)) {
        const std::uint32_t* line = u == v ? nullptr : piece_.line(u, v);
        if (line && std::find(line_ends_.begin(), line_ends_.end(), u) == line_ends_.end()) {
          line_ends_.push_back(u);
          if (*line == Parts::kStays || (path && *path != *line)) return false;
          path = *line;
        }
      }
    }
    if (piece_.vertices[v].kind == Kind::kCurve) return line_ends_.size() == 2;
    return !walls_.empty();
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
                                                      (walls_[0].wall & kOuter) != 0, wall_normal(), reach);
    if (home) to.at = *home;
    return home.has_value();
  }

  bool walls_stay_true(const Vertex& to) const {
    if (to.kind == Kind::kInner) return true;
    for (const WallAt& w : walls_) {
      const Vec3 b = piece_.point(w.corners[1]), c = piece_.point(w.corners[2]);
      const std::array<TriangleCorners, 1> before{{{piece_.point(w.corners[0]), b, c}}}, after{{{to.at, b, c}}};
      if (!keeps_walls_true(guide_, before, after, w.wall)) return false;
    }
    return true;
  }

  Piece& piece_;
  const Guide& guide_;
  std::vector<TetIndex> star_;
  std::vector<float> scores_;
  std::vector<WallAt> walls_;
  std::vector<VertexIndex> line_ends_;
  int steps_ = 0;
};

/// Triangles of walls turn by no more than this (cosine) against the ground, or by no more than they did.
constexpr double kLeastCosineOfWall = 0.8;

}  // namespace

bool keeps_walls_true(const Guide& guide, std::span<const TriangleCorners> before,
                      std::span<const TriangleCorners> after, Wall wall) {
  const std::uint32_t part = (wall & ~kOuter) - 1;
  const bool outer = (wall & kOuter) != 0;
  const auto worst_of = [&](std::span<const TriangleCorners> triangles) {
    Ground::Truth worst;
    for (const TriangleCorners& t : triangles) {
      const double edge = std::sqrt(longest_squared_edge(t[0], t[1], t[2]));
      const Ground::Truth truth = guide.ground.truth_of(t, part, outer, edge);
      worst = {std::max(worst.distance, truth.distance), std::min(worst.cosine, truth.cosine)};
    }
    return worst;
  };
  const Ground::Truth has = worst_of(after);
  if (has.distance <= guide.tolerance && has.cosine >= kLeastCosineOfWall) return true;
  const Ground::Truth had = worst_of(before);
  return std::isfinite(has.distance) && has.distance <= std::max(guide.tolerance, had.distance) &&
         has.cosine >= std::min(kLeastCosineOfWall, had.cosine);
}

PassCount smooth_vertices(Piece& piece, const Guide& guide, float threshold) {
  return VertexMover(piece, guide).run(threshold);
}

}  // namespace octafront::adapt
