#include "improve/schedule/without_bridges.h"

#include <octafront/quality.h>

#include "base/core/flat_map.h"
#include "base/geometry/predicates.h"
#include "base/mesh/adjacency.h"
#include "base/mesh/edge_table.h"
#include "base/mesh/face_table.h"
#include "base/mesh/labels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace octafront {
namespace {

/// Elements of less beta than this are made nowhere: rather the element stays what it is.
constexpr double kLeastOfBridge = 0.02;
/// Sweeps over the new vertices, and the steps that they try, in parts of the shortest edge around.
constexpr int kSweepsOfBridges = 4;
constexpr std::array<double, 3> kStepsOfBridges{0.3, 0.1, 0.03};
constexpr std::size_t kCheckBridgesEvery = 256;

class BridgeDivider {
 public:
  explicit BridgeDivider(TetMesh& mesh) : mesh_(mesh), on_wall_(mesh.points.size(), 0), fixed_(mesh.tets.size(), 0) {
    for (const auto* faces : {&mesh.boundary, &mesh.interfaces})
      for (const Triangle& f : *faces) {
        add_wall(f);
        for (const VertexIndex v : f) on_wall_[v] = 1;
      }
    for (const Edge& e : mesh.curve_edges) lines_.insert(sorted_edge(e[0], e[1]));
    for (const WideCell& cell : mesh.wide_cells)
      for (std::uint32_t k = 0; k < cell.tet_count; ++k) fixed_[cell.first + k] = 1;
    for (TetIndex t = 0; t < mesh.tets.size(); ++t) original_.push_back(t);
  }

  Bridges run(const Stage& stage) {
    Bridges found;
    std::vector<TetIndex> bridges;
    for (TetIndex t = 0; t < mesh_.tets.size(); ++t)
      if (!fixed_[t] && is_bridge(t)) bridges.push_back(t);
    found.had = bridges.size();
    if (bridges.empty()) return found;
    TetMesh before;  // as to its elements
    before.region = mesh_.region, before.wide_cells = mesh_.wide_cells, before.sets = mesh_.sets;
    const auto first_new = static_cast<VertexIndex>(mesh_.points.size());
    add_borders();
    connect();
    for (std::size_t k = 0; k < bridges.size(); ++k) {
      if (k % kCheckBridgesEvery == 0) stage.check();
      if (is_bridge(bridges[k]) && !divide(bridges[k])) ++found.left;
    }
    for (int sweep = 0; sweep < kSweepsOfBridges; ++sweep) {
      stage.check();
      for (VertexIndex v = first_new; v < mesh_.points.size(); ++v) move(v);
    }
    found.vertices = mesh_.points.size() - first_new;
    inherit(mesh_, before, NamedSet::Kind::kElements, original_);
    return found;
  }

 private:
  bool is_bridge(TetIndex t) const {
    const Tet& c = mesh_.tets[t];
    return std::all_of(c.begin(), c.end(), [&](VertexIndex v) { return on_wall_[v] != 0; });
  }

  /// Faces between elements of other labels stay, too.
  void add_borders() {
    const Labels labels = labels_of(mesh_, NamedSet::Kind::kElements);
    if (labels.like.size() < 2) return;
    const std::vector<HalfFace> across = half_face_neighbors(mesh_.tets, mesh_.points.size());
    for (HalfFace h = 0; h < across.size(); ++h)
      if (across[h] != kNone && labels.of[h / 4] != labels.of[across[h] / 4]) add_wall(corners_of(mesh_.tets, h));
  }
  void add_wall(const Triangle& f) {
    walls_.insert(face_key(f));
    for (std::size_t i = 0; i < 3; ++i) lines_.insert(sorted_edge(f[i], f[(i + 1) % 3]));
  }

  void connect() {
    around_.resize(mesh_.points.size());
    for (TetIndex t = 0; t < mesh_.tets.size(); ++t)
      for (const VertexIndex v : mesh_.tets[t]) around_[v].push_back(t);
  }
  bool has(TetIndex t, VertexIndex v) const {
    const Tet& c = mesh_.tets[t];
    return std::find(c.begin(), c.end(), v) != c.end();
  }

  /// Beta with another place for a vertex; 0 if the element is not positive.
  double worth_with(const Tet& c, VertexIndex v, Vec3 at) const {
    std::array<Vec3, 4> p;
    for (std::size_t i = 0; i < 4; ++i) p[i] = c[i] == v ? at : mesh_.points[c[i]];
    return orient3d(p[0], p[1], p[2], p[3]) > 0 ? radius_ratio(p[0], p[1], p[2], p[3]) : 0;
  }

  /// A place for a new vertex, and the elements that are divided there: each corner of the part of them that the vertex
  /// lies within goes once.
  struct Plan {
    double worst = kLeastOfBridge;
    Vec3 at;
    std::vector<VertexIndex> part;  ///< the corners of the edge, face or element
    std::vector<TetIndex> old;
  };

  bool divide(TetIndex t) {
    const Tet c = mesh_.tets[t];
    Plan best;
    for (const auto& [i, j] : kTetEdges)
      if (!lines_.contains(sorted_edge(c[static_cast<std::size_t>(i)], c[static_cast<std::size_t>(j)])))
        try_part({c[static_cast<std::size_t>(i)], c[static_cast<std::size_t>(j)]}, best);
    for (int i = 0; i < 4; ++i) {
      const Triangle f = face_of(c, i);
      if (!walls_.contains(face_key(f))) try_part({f[0], f[1], f[2]}, best);
    }
    try_part({c[0], c[1], c[2], c[3]}, best);
    if (best.old.empty()) return false;
    apply(best);
    return true;
  }

  void try_part(std::vector<VertexIndex> part, Plan& best) const {
    Plan plan;
    for (const VertexIndex v : part) plan.at += (1.0 / static_cast<double>(part.size())) * mesh_.points[v];
    for (const TetIndex t : around_[part[0]]) {
      if (!std::all_of(part.begin() + 1, part.end(), [&](VertexIndex v) { return has(t, v); })) continue;
      if (fixed_[t]) return;
      plan.old.push_back(t);
    }
    plan.worst = 1;
    for (const TetIndex t : plan.old)
      for (const VertexIndex gone : part) plan.worst = std::min(plan.worst, worth_with(mesh_.tets[t], gone, plan.at));
    if (!(plan.worst > best.worst)) return;
    plan.part = std::move(part);
    best = std::move(plan);
  }

  void apply(const Plan& plan) {
    const auto v = static_cast<VertexIndex>(mesh_.points.size());
    mesh_.points.push_back(plan.at);
    on_wall_.push_back(0);
    around_.emplace_back();
    for (const TetIndex t : plan.old) {
      const Tet c = mesh_.tets[t];
      for (std::size_t k = 0; k < plan.part.size(); ++k) {
        Tet made = c;
        std::replace(made.begin(), made.end(), plan.part[k], v);
        k == 0 ? replace(t, made) : add(t, made);
      }
    }
  }
  void replace(TetIndex t, const Tet& made) {
    for (const VertexIndex v : mesh_.tets[t]) std::erase(around_[v], t);
    mesh_.tets[t] = made;
    for (const VertexIndex v : made) around_[v].push_back(t);
  }
  /// One more element of what t was divided into.
  void add(TetIndex t, const Tet& made) {
    const auto number = static_cast<TetIndex>(mesh_.tets.size());
    mesh_.tets.push_back(made);
    fixed_.push_back(0);
    original_.push_back(original_[t]);
    for (const VertexIndex v : made) around_[v].push_back(number);
  }

  double worst_at(VertexIndex v, Vec3 at) const {
    double worst = 1;
    for (const TetIndex t : around_[v]) worst = std::min(worst, worth_with(mesh_.tets[t], v, at));
    return worst;
  }
  /// To the best of some places around, one step after the other.
  void move(VertexIndex v) {
    double shortest = HUGE_VAL, worst = worst_at(v, mesh_.points[v]);
    for (const TetIndex t : around_[v])
      for (const VertexIndex u : mesh_.tets[t])
        if (u != v) shortest = std::min(shortest, distance(mesh_.points[u], mesh_.points[v]));
    for (const double step : kStepsOfBridges)
      for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {1.0, -1.0}) {
          Vec3 at = mesh_.points[v];
          at[axis] += sign * step * shortest;
          const double w = worst_at(v, at);
          if (w > worst) worst = w, mesh_.points[v] = at;
        }
  }

  TetMesh& mesh_;
  std::vector<std::uint8_t> on_wall_, fixed_;
  FlatSet<Triangle> walls_;
  FlatSet<Edge> lines_;
  std::vector<TetIndex> original_;  ///< per element the one of the mesh that came which it is a part of
  std::vector<std::vector<TetIndex>> around_;
};

}  // namespace

Bridges avoid_bridges(TetMesh& mesh, const Stage& stage) {
  return BridgeDivider(mesh).run(stage);
}

}  // namespace octafront
