#include "improve/schedule/raise_flat.h"

#include "base/core/groups.h"
#include "base/core/parallel.h"
#include "base/core/shared_value.h"
#include "base/geometry/live_triangles.h"
#include "base/geometry/measures.h"
#include "base/shared/marks.h"
#include "base/shared/packing.h"
#include "improve/passes/fewest_poor.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace octafront {

namespace {

using improve::Shape;
using improve::ShapeBatch;

/// Scores below this are beta below .2 or angles as bad.
constexpr float kPoorToRaise = 0.2f;
/// Elements made poor by a move are looked at again, so often at most.
constexpr int kRaiseRounds = 6;
/// Steps of a vertex at most, and what the sum of what elements lack must fall by.
constexpr int kStepsOfRaise = 12;
constexpr double kLeastFallByRaise = 0.1;
/// Parts of the reach at which places are tried, and the reach in edges.
constexpr double kParts[] = {0.3, 0.9};
constexpr double kReach = 0.3;

/// The triangles of a surface whose vertices move with those of a mesh, for LiveTriangles.
struct MovingSurface {
  const std::vector<Vec3>& points;
  const std::vector<Triangle>& triangles;
  std::size_t triangle_count() const { return triangles.size(); }
  static bool is_removed(std::size_t) { return false; }
  const Triangle& triangle(std::size_t t) const { return triangles[t]; }
  Vec3 corner(std::size_t t, int i) const { return points[triangles[t][i]]; }
};

class FlatRaiser {
 public:
  FlatRaiser(TetMesh& mesh, const SurfaceMesh& filled, const RaiseLimits& limits, const Comm& comm)
      : mesh_(mesh),
        filled_(filled),
        limits_(limits),
        comm_(comm),
        surface_{mesh.points, filled.triangles},
        live_(surface_) {
    is_fixed_.resize(mesh.points.size(), 0);
    if (limits.fixed)
      for (const VertexIndex v : *limits.fixed) is_fixed_[v] = 1;
  }

  RaisedFlat run(const Stage& stage) {
    for (int round = 0; round < kRaiseRounds; ++round) {
      stage.check();
      find_near();
      const std::vector<TetIndex> poor = find_poor();
      if (poor.empty()) break;
      gather(poor);
      std::uint64_t moved = 0;
      for (const TetIndex t : poor) moved += raise(t);
      raised_.vertices += moved;
      if (moved == 0) break;
    }
    return raised_;
  }

 private:
  Shape shape_of(const Tet& t) const {
    const auto& [a, b, c, d] = t;
    return improve::shape_of(mesh_.points[a], mesh_.points[b], mesh_.points[c], mesh_.points[d]);
  }

  /// All elements around corners of poor ones, of all ranks.
  void find_near() {
    std::vector<std::uint8_t> marks(mesh_.points.size(), 0);
    parallel_for(mesh_.tets.size(), [&](std::size_t t) {
      if (shape_of(mesh_.tets[t]).score >= kPoorToRaise) return;
      for (const VertexIndex v : mesh_.tets[t]) SharedValue(marks[v]).store(1);
    });
    join_marks(comm_, marks, "flat elements");
    near_.clear();
    for (const Tet& t : mesh_.tets)
      if (std::ranges::any_of(t, [&](VertexIndex v) { return marks[v] != 0; })) near_.push_back(t);
    near_ = gathered_lists(comm_, near_, "flat elements");
  }

  /// Worst first.
  std::vector<TetIndex> find_poor() const {
    std::vector<float> score(near_.size());
    parallel_for(score.size(), [&](std::size_t t) { score[t] = shape_of(near_[t]).score; });
    std::vector<TetIndex> poor;
    for (TetIndex t = 0; t < score.size(); ++t)
      if (score[t] < kPoorToRaise) poor.push_back(t);
    std::sort(poor.begin(), poor.end(),
              [&](TetIndex s, TetIndex t) { return std::pair(score[s], s) < std::pair(score[t], t); });
    return poor;
  }

  /// The stars of all corners of these elements.
  void gather(const std::vector<TetIndex>& poor) {
    number_.assign(mesh_.points.size(), kNone);
    std::uint32_t count = 0;
    for (const TetIndex t : poor)
      for (const VertexIndex v : near_[t])
        if (number_[v] == kNone) number_[v] = count++;
    tets_ = Groups<>(count, [&](const auto& add) {
      for (TetIndex t = 0; t < near_.size(); ++t)
        for (const VertexIndex v : near_[t])
          if (number_[v] != kNone) add(number_[v], t);
    });
    triangles_ = Groups<>(count, [&](const auto& add) {
      for (std::uint32_t t = 0; t < filled_.triangles.size(); ++t)
        for (const VertexIndex v : filled_.triangles[t])
          if (number_[v] != kNone) add(number_[v], t);
    });
  }

  /// Moves one corner of the element, if one may and that helps.
  bool raise(TetIndex t) {
    const Tet& corners = near_[t];
    if (shape_of(corners).score >= kPoorToRaise || is_forced(corners)) return false;
    return std::any_of(corners.begin(), corners.end(), [&](VertexIndex v) { return move(v); });
  }

  /// Narrow corners of curves are no reason: where nothing but noise makes them, a move within the limits opens them,
  /// and the corners of flat faces stay anyway.
  bool is_forced(const Tet& t) const {
    if (limits_.force == nullptr) return false;
    const auto& [a, b, c, d] = t;
    const Vec3 p = mesh_.points[a], q = mesh_.points[b], r = mesh_.points[c], s = mesh_.points[d];
    using Cause = improve::InputForce::Cause;
    const Cause cause = limits_.force->cause_at(centroid(p, q, r, s), std::sqrt(longest_squared_edge(p, q, r, s)));
    return cause == Cause::kThin || cause == Cause::kWedge;
  }

  double allowed_at(Vec3 home) const {
    return limits_.leeway ? limits_.leeway->at(home, limits_.distance) : limits_.distance;
  }

  bool move(VertexIndex v) {
    const auto star = tets_[number_[v]];
    const auto around = triangles_[number_[v]];
    if (is_fixed_[v] || star.size() > ShapeBatch::kBatch || lies_on_flat(around)) return false;
    load(v, star);
    const Vec3 from = mesh_.points[v], home = home_of(v);
    const double reach = std::min(kReach * star_.mean_edge(from), around.empty() ? HUGE_VAL : allowed_at(home));
    star_.evaluate_star(from);
    const double had = lack_of(star_);
    const bool is_held = !around.empty() && limits_.input != nullptr;
    const auto allowed = [&](Vec3 to) {
      return distance(home, to) <= reach && star_.star_acceptable(to, positive_) &&
             !(is_held && !limits_.input->is_within(to, limits_.from_input));
    };
    descent_.descend(star_, best_around(home, reach, from, had, allowed), kStepsOfRaise, allowed);
    if (had - descent_.lack() < kLeastFallByRaise) return false;
    mesh_.points[v] = descent_.place();
    live_.note_changed(around);
    if (live_.crossings_among(around) == 0) {
      note_move(v, home, around);
      return true;
    }
    mesh_.points[v] = from;
    live_.note_changed(around);
    return false;
  }

  /// Of places around `home`, that with the least lack; `from` if none is better. Where an element is flat, slopes say
  /// little.
  template <typename Allowed>
  Vec3 best_around(Vec3 home, double reach, Vec3 from, double had, const Allowed& allowed) {
    Vec3 best = from;
    for (const double part : kParts)
      for (int k = 0; k < 27; ++k) {
        const Vec3 way{k % 3 - 1.0, k / 3 % 3 - 1.0, k / 9 - 1.0};
        if (squared_length(way) == 0) continue;
        const Vec3 to = home + normalized(way) * (part * reach);
        star_.evaluate_star(to);
        const double lack = lack_of(star_);
        if (lack < had && allowed(to)) best = to, had = lack;
      }
    return best;
  }

  void note_move(VertexIndex v, Vec3 home, std::span<const std::uint32_t> around) {
    if (around.empty()) return;
    homes_.try_emplace(v, home);
    raised_.largest_move = std::max(raised_.largest_move, distance(home, mesh_.points[v]));
  }

  Vec3 home_of(VertexIndex v) const {
    const auto found = homes_.find(v);
    return found == homes_.end() ? mesh_.points[v] : found->second;
  }

  /// The elements around v, with v as their first corner.
  void load(VertexIndex v, std::span<const TetIndex> star) {
    star_.size = 0;
    for (const TetIndex t : star) {
      const Tet& c = near_[t];
      const auto corner = std::find(c.begin(), c.end(), v) - c.begin();
      const auto& f = kTetFaces[corner];
      star_.add(mesh_.points[c[f[0]]], mesh_.points[c[f[1]]], mesh_.points[c[f[2]]]);
    }
  }

  bool lies_on_flat(std::span<const std::uint32_t> around) const {
    if (limits_.walls == nullptr) return false;
    std::vector<TriangleCorners> corners;
    for (const std::uint32_t t : around) corners.push_back(live_.corners(t));
    return limits_.walls->hold(corners);
  }

  TetMesh& mesh_;
  const SurfaceMesh& filled_;
  const RaiseLimits limits_;
  const Comm comm_;
  const MovingSurface surface_;
  LiveTriangles<MovingSurface> live_;
  std::vector<std::uint8_t> is_fixed_;
  std::vector<Tet> near_;              ///< elements, those around corners of poor ones
  std::vector<std::uint32_t> number_;  ///< of each vertex whose star was gathered
  Groups<> tets_, triangles_;          ///< by that number
  std::map<VertexIndex, Vec3> homes_;  ///< where vertices of surfaces that moved were
  ShapeBatch star_;
  improve::LackDescent descent_;
  const improve::Floor positive_{0, 0, 0, 0};
  RaisedFlat raised_;
};

}  // namespace

RaisedFlat raise_flat(TetMesh& mesh, const SurfaceMesh& filled, const RaiseLimits& limits, const Stage& stage,
                      Tets tets) {
  const Comm comm(tets == Tets::kShare ? stage.context().ranks : nullptr);
  return FlatRaiser(mesh, filled, limits, comm).run(stage);
}

}  // namespace octafront
