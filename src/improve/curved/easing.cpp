#include "improve/curved/easing.h"

#include "base/core/parallel.h"
#include "base/geometry/measures.h"
#include "base/geometry/predicates.h"
#include "base/mesh/quadratic_nodes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace octafront::curved {

namespace {

// Of its volume before, an element keeps this when its corners move.
constexpr double kLeastVolume = 0.5;

/// A node on its way: how often it has gone halfway back.
struct Way {
  Vec3 from, by;
  int halvings = 0;

  bool is_left() const { return halvings < kMostHalvings; }
  Vec3 place() const { return is_left() ? from + std::ldexp(1, -halvings) * by : from; }
  double length_left() const { return is_left() ? std::ldexp(length(by), -halvings) : 0; }
};

/// Nodes on their ways, and the tetrahedra that care: those of which some node moves.
template <std::size_t kNodes>
class Easing {
 public:
  using NodesOfTet = std::array<VertexIndex, kNodes>;

  Easing(TetMesh& mesh, const std::vector<NodesOfTet>& nodes, std::vector<std::pair<VertexIndex, Way>> ways)
      : mesh_(mesh), nodes_(nodes), ways_(std::move(ways)), way_of_(mesh.points.size(), kNone) {
    for (std::uint32_t i = 0; i < ways_.size(); ++i) way_of_[ways_[i].first] = i;
    std::vector<char> moves(nodes.size());
    parallel_for(nodes.size(), [&](std::size_t t) {
      for (const VertexIndex v : nodes_[t]) moves[t] |= way_of_[v] != kNone;
    });
    for (TetIndex t = 0; t < moves.size(); ++t)
      if (moves[t]) tets_.push_back(t);
  }

  const std::vector<TetIndex>& tets() const { return tets_; }
  const std::vector<std::pair<VertexIndex, Way>>& ways() const { return ways_; }

  /// Calls choose(node numbers of a bad tet, give_way) until is_good(t) holds for all, or nothing is left to give way.
  template <class IsGood, class Choose>
  void settle(const IsGood& is_good, const Choose& choose, const RunContext& context) {
    for (const auto& [v, way] : ways_) mesh_.points[v] = way.place();
    settle_tets(
        tets_, is_good, [&](TetIndex t, std::vector<std::uint32_t>& back) { choose(ways_left(t), back); },
        [&](const std::vector<std::uint32_t>& back) { return go_back(back); }, context);
  }

  const Way& way(std::uint32_t i) const { return ways_[i].second; }
  const Way& way_of(VertexIndex v) const { return way(way_of_[v]); }

 private:
  std::vector<std::uint32_t> ways_left(TetIndex t) const {
    std::vector<std::uint32_t> left;
    for (const VertexIndex v : nodes_[t])
      if (way_of_[v] != kNone && way(way_of_[v]).is_left()) left.push_back(way_of_[v]);
    return left;
  }

  /// Returns the tets that this changes.
  std::vector<TetIndex> go_back(const std::vector<std::uint32_t>& back) {
    std::vector<char> changed(ways_.size());
    for (const std::uint32_t i : back) {
      auto& [v, way] = ways_[i];
      ++way.halvings;
      mesh_.points[v] = way.place();
      changed[i] = 1;
    }
    std::vector<TetIndex> touched;
    if (back.empty()) return touched;
    for (const TetIndex t : tets_)
      if (std::any_of(nodes_[t].begin(), nodes_[t].end(),
                      [&](VertexIndex v) { return way_of_[v] != kNone && changed[way_of_[v]]; }))
        touched.push_back(t);
    return touched;
  }

  TetMesh& mesh_;
  const std::vector<NodesOfTet>& nodes_;
  std::vector<std::pair<VertexIndex, Way>> ways_;
  std::vector<std::uint32_t> way_of_;  // per point
  std::vector<TetIndex> tets_;
};

// Inner corners next to the boundary go along for this part of what the boundary there does on average, lest the
// elements between be squeezed.
constexpr double kFollow = 0.5;

/// The ways of the boundary's corners, and of their inner neighbours.
std::vector<std::pair<VertexIndex, Way>> ways_with_followers(const TetMesh& mesh, std::span<const CornerMove> moves) {
  std::vector<char> outside(mesh.points.size(), 0);
  for (const auto* faces : {&mesh.boundary, &mesh.interfaces})
    for (const Triangle& t : *faces)
      for (const VertexIndex v : t) outside[v] = 1;
  std::vector<Vec3> by(mesh.points.size());
  std::vector<std::uint32_t> seen(mesh.points.size(), 0);
  for (const auto& [v, move] : moves) by[v] = move, outside[v] = 1;
  for (const Tet& tet : mesh.tets)
    for (const VertexIndex v : tet)
      for (const VertexIndex u : tet)
        if (!outside[v] && outside[u]) {
          by[v] += by[u];
          ++seen[v];
        }
  std::vector<std::pair<VertexIndex, Way>> ways;
  for (VertexIndex v = 0; v < mesh.points.size(); ++v) {
    if (seen[v] > 0) by[v] *= kFollow / seen[v];
    if (by[v] != Vec3{}) ways.push_back({v, {mesh.points[v], by[v]}});
  }
  return ways;
}

double six_volumes_of(const TetMesh& mesh, TetIndex t) {
  const auto& [a, b, c, d] = mesh.tets[t];
  return six_volumes(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]);
}

bool is_positive(const TetMesh& mesh, TetIndex t) {
  const auto& [a, b, c, d] = mesh.tets[t];
  return orient3d(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]) > 0;
}

}  // namespace

void move_corners(TetMesh& mesh, std::span<const CornerMove> moves, SecondOrderSummary& summary,
                  const RunContext& context) {
  if (moves.empty()) return;
  Easing<4> easing(mesh, mesh.tets, ways_with_followers(mesh, moves));
  std::vector<double> before(mesh.tets.size());
  for (const TetIndex t : easing.tets()) before[t] = six_volumes_of(mesh, t);
  easing.settle([&](TetIndex t) { return six_volumes_of(mesh, t) >= kLeastVolume * before[t] && is_positive(mesh, t); },
                [](const std::vector<std::uint32_t>& left, std::vector<std::uint32_t>& back) {
                  back.insert(back.end(), left.begin(), left.end());
                },
                context);
  for (const auto& [v, by] : moves) ++(easing.way_of(v).halvings == 0 ? summary.moved : summary.held);
}

void bend_edges(TetMesh& mesh, const TetEdges& edges, std::span<const EdgeBend> bends, SecondOrderSummary& summary,
                const RunContext& context) {
  const auto first = static_cast<VertexIndex>(mesh.points.size() - edges.size());
  std::vector<std::pair<VertexIndex, Way>> ways;
  for (const auto& [edge, by] : bends) {
    const VertexIndex v = first + edges.find(edge[0], edge[1]);
    ways.push_back({v, {mesh.points[v], by[0]}});
  }
  Easing<6> easing(mesh, mesh.mid_nodes, std::move(ways));
  easing.settle(
      [&](TetIndex t) {
        const QuadraticTet nodes = quadratic_nodes(mesh, t);
        const auto coefficients = jacobian_coefficients(nodes);
        const double least = *std::min_element(coefficients.begin(), coefficients.end());
        return least >= kLeastScaledJacobian * six_volumes_of(mesh, t) && has_positive_jacobian(nodes);
      },
      [&](const std::vector<std::uint32_t>& left, std::vector<std::uint32_t>& back) {
        const auto most = std::max_element(left.begin(), left.end(), [&](std::uint32_t i, std::uint32_t k) {
          return easing.way(i).length_left() < easing.way(k).length_left();
        });
        if (most != left.end()) back.push_back(*most);
      },
      context);
  for (const auto& [v, way] : easing.ways()) {
    ++(way.halvings == 0 ? summary.curved : summary.eased);
    const std::uint32_t e = v - first;
    const double edge = distance(mesh.points[edges.low[e]], mesh.points[edges.high[e]]);
    summary.largest_bend = std::max(summary.largest_bend, way.length_left() / edge);
  }
  summary.edges = edges.size();
  summary.straight = summary.edges - summary.curved - summary.eased;
}

}  // namespace octafront::curved
