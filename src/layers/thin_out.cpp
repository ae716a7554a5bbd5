#include "base/geometry/measures.h"
#include "base/geometry/predicates.h"
#include "layers/through.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

namespace octafront::layers {

namespace {

/// Least cosine of the dihedral angles 12 and 168 degrees, up to which collapses make elements of good ones; and of 14
/// and 166, up to which nodes are moved.
constexpr double kCollapseCosine = 0.97815, kMoveCosine = 0.9703;
constexpr int kCollapseRounds = 4, kMoveRounds = 6;
/// A node tries these parts of the ways to its neighbours, from the first on, halved where none serves.
constexpr double kFirstStep = 0.25;
constexpr int kMoveHalvings = 6, kMostTries = 24;
/// Better by less is no gain.
constexpr double kGain = 1e-6;
constexpr double kInverted = 2;

/// The largest magnitude of the cosines of an element's dihedral angles: 1 is flat; kInverted: it is not positive.
double worst_cosine(const std::array<Vec3, 4>& x) {
  if (orient3d(x[0], x[1], x[2], x[3]) <= 0) return kInverted;
  std::array<Vec3, 4> normal;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& f = kTetFaces[i];
    normal[i] = unit_normal(x[static_cast<std::size_t>(f[0])], x[static_cast<std::size_t>(f[1])],
                            x[static_cast<std::size_t>(f[2])]);
  }
  double worst = 0;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j) worst = std::max(worst, std::abs(dot(normal[i], normal[j])));
  return worst;
}

class Thinner {
 public:
  Thinner(TetMesh& mesh, std::size_t surface_points, std::vector<std::uint32_t> level, const RunContext& context)
      : mesh_(mesh), first_(surface_points), level_(std::move(level)), context_(context), star_(mesh.points.size()) {
    for (TetIndex t = 0; t < mesh.tets.size(); ++t) {
      cosine_.push_back(worst_cosine(corners(mesh.tets[t])));
      for (const VertexIndex v : mesh.tets[t]) star_[v].push_back(t);
    }
  }

  ThinnedOut run() {
    for (int round = 0; round < kCollapseRounds; ++round)
      if (!for_each_node([&](VertexIndex v) { return collapse(v); }, done_.collapsed)) break;
    for (int round = 0; round < kMoveRounds; ++round)
      if (!for_each_node([&](VertexIndex v) { return move(v); }, done_.moved)) break;
    for_each_node([&](VertexIndex v) { return collapse(v); }, done_.collapsed);
    drop_unused();
    done_.level = std::move(level_);
    return std::move(done_);
  }

 private:
  std::array<Vec3, 4> corners(const Tet& t) const {
    return {mesh_.points[t[0]], mesh_.points[t[1]], mesh_.points[t[2]], mesh_.points[t[3]]};
  }

  /// Whether anything was done.
  template <class Work>
  bool for_each_node(const Work& work, std::uint64_t& count) {
    const std::uint64_t before = count;
    for (auto v = static_cast<VertexIndex>(first_); v < mesh_.points.size(); ++v) {
      if (v % 4096 == 0) context_.check();
      if (level_[v] > 0 && !star_[v].empty() && work(v)) ++count;
    }
    return count > before;
  }

  double worst_around(VertexIndex v) const {
    double worst = 0;
    for (const TetIndex t : star_[v]) worst = std::max(worst, cosine_[t]);
    return worst;
  }

  std::vector<VertexIndex> neighbours(VertexIndex v) const {
    std::vector<VertexIndex> all;
    for (const TetIndex t : star_[v])
      for (const VertexIndex u : mesh_.tets[t])
        if (u != v) all.push_back(u);
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  }

  static bool has(const Tet& tet, VertexIndex v) { return std::find(tet.begin(), tet.end(), v) != tet.end(); }

  /// The worst cosine around v if it went onto `to`, as far as that is below `limit`.
  double worst_after(VertexIndex v, VertexIndex to, double limit) const {
    double worst = 0;
    for (const TetIndex t : star_[v]) {
      Tet tet = mesh_.tets[t];
      if (has(tet, to)) continue;
      std::replace(tet.begin(), tet.end(), v, to);
      worst = std::max(worst, worst_cosine(corners(tet)));
      if (worst >= limit) break;
    }
    return worst;
  }

  bool collapse(VertexIndex v) {
    double limit = std::max(kCollapseCosine, worst_around(v));
    VertexIndex best = kNone;
    for (const VertexIndex u : neighbours(v)) {
      if (level_[u] != level_[v] || !is_linked_simply(v, u)) continue;
      const double worst = worst_after(v, u, limit);
      if (worst < limit) limit = worst, best = u;
    }
    if (best == kNone) return false;
    put_onto(v, best);
    return true;
  }

  /// Vertices that are neighbours of both are those of elements at the edge: else the collapse would pinch the mesh.
  bool is_linked_simply(VertexIndex v, VertexIndex u) const {
    std::vector<VertexIndex> at_edge;
    for (const TetIndex t : star_[v])
      if (has(mesh_.tets[t], u))
        for (const VertexIndex w : mesh_.tets[t])
          if (w != v && w != u) at_edge.push_back(w);
    std::sort(at_edge.begin(), at_edge.end());
    at_edge.erase(std::unique(at_edge.begin(), at_edge.end()), at_edge.end());
    const std::vector<VertexIndex> of_v = neighbours(v), of_u = neighbours(u);
    std::vector<VertexIndex> both;
    std::set_intersection(of_v.begin(), of_v.end(), of_u.begin(), of_u.end(), std::back_inserter(both));
    return both == at_edge;
  }

  void put_onto(VertexIndex v, VertexIndex to) {
    for (const TetIndex t : star_[v]) {
      Tet& tet = mesh_.tets[t];
      if (has(tet, to)) {
        for (const VertexIndex u : tet)
          if (u != v) std::erase(star_[u], t);
        tet[0] = kNone;
        continue;
      }
      std::replace(tet.begin(), tet.end(), v, to);
      cosine_[t] = worst_cosine(corners(tet));
      star_[to].push_back(t);
    }
    star_[v].clear();
  }

  bool move(VertexIndex v) {
    const double before = worst_around(v);
    if (before < kMoveCosine) return false;
    const std::vector<VertexIndex> around = neighbours(v);
    double worst = before, step = kFirstStep;
    for (int halvings = 0, tries = 0; halvings < kMoveHalvings && tries < kMostTries; ++tries) {
      const Vec3 from = mesh_.points[v];
      Vec3 best = from;
      for (const VertexIndex u : around) {
        mesh_.points[v] = from + step * (mesh_.points[u] - from);
        const double there = worst_at(v, worst - kGain);
        if (there < worst - kGain) worst = there, best = mesh_.points[v];
      }
      mesh_.points[v] = best;
      if (best == from) step /= 2, ++halvings;
    }
    for (const TetIndex t : star_[v]) cosine_[t] = worst_cosine(corners(mesh_.tets[t]));
    return worst < before;
  }

  double worst_at(VertexIndex v, double limit) const {
    double worst = 0;
    for (const TetIndex t : star_[v]) {
      worst = std::max(worst, worst_cosine(corners(mesh_.tets[t])));
      if (worst >= limit) break;
    }
    return worst;
  }

  void drop_unused() {
    std::size_t kept = 0;
    for (TetIndex t = 0; t < mesh_.tets.size(); ++t) {
      if (mesh_.tets[t][0] == kNone) continue;
      if (!mesh_.region.empty()) mesh_.region[kept] = mesh_.region[t];
      mesh_.tets[kept++] = mesh_.tets[t];
    }
    mesh_.tets.resize(kept);
    if (!mesh_.region.empty()) mesh_.region.resize(kept);
    std::vector<VertexIndex> number(mesh_.points.size(), kNone);
    VertexIndex next = 0;
    for (VertexIndex v = 0; v < number.size(); ++v) {
      if (v >= first_ && star_[v].empty()) continue;
      number[v] = next;
      mesh_.points[next] = mesh_.points[v];
      level_[next++] = level_[v];
    }
    mesh_.points.resize(next);
    level_.resize(next);
    for (Tet& tet : mesh_.tets)
      for (VertexIndex& v : tet) v = number[v];
  }

  TetMesh& mesh_;
  std::size_t first_;
  std::vector<std::uint32_t> level_;
  const RunContext& context_;
  std::vector<std::vector<TetIndex>> star_;
  std::vector<double> cosine_;
  ThinnedOut done_;
};

}  // namespace

ThinnedOut thin_out(TetMesh& mesh, std::size_t surface_points, std::vector<std::uint32_t> level,
                    const RunContext& context) {
  return Thinner(mesh, surface_points, std::move(level), context).run();
}

}  // namespace octafront::layers
