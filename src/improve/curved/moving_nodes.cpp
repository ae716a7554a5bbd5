#include "improve/curved/moving_nodes.h"

#include <octafront/run_context.h>

#include "base/core/groups.h"
#include "base/core/parallel.h"
#include "base/geometry/curved_tet.h"
#include "base/geometry/tet_lattice.h"
#include "base/mesh/quadratic_nodes.h"
#include "improve/curved/easing.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

namespace octafront::curved {

namespace {

// Sweeps over all poor elements, and those that only elements take part in that edges would have to go back for.
constexpr int kSweepsOfAll = 2, kSweepsOfNodes = 12;
// Milliseconds each: all that edges and faces would have to go back for, and of the others one in so many elements.
constexpr std::size_t kOthersOneIn = 200;
/// Steps in parts of the shortest edge of the element, or of an edge along a wall: a try with each, then half of it.
constexpr double kFirstStepOfNodes = 0.1;
constexpr int kStepsOfNodes = 4;

/// A node on a wall, and where the nodes of its element begin, as they were at first.
struct NodeOnWall {
  SlidNode now;
  std::size_t nodes;

  VertexIndex node() const { return now.node; }
};

class MovingNodes {
 public:
  MovingNodes(TetMesh& mesh, double wanted, const std::vector<char>& is_on_wall, Walls walls)
      : mesh_(mesh),
        lattice_(tet_lattice(mesh.order())),
        wanted_(wanted),
        walls_(walls),
        each_(mesh.high_nodes_per_tet()),
        on_wall_(is_on_wall) {}

  NodesMoved run(std::span<const TetIndex> among, const RunContext& context) {
    find_poor(among);
    if (poor_.empty()) return {};
    gather();
    if (walls_ == Walls::kSlide) take_nodes_on_walls();
    for (int sweep = 0; sweep < kSweepsOfNodes; ++sweep) {
      // Where nothing moved nothing will.
      std::erase_if(poor_, [&](TetIndex t) {
        context.check();
        return (sweep >= kSweepsOfAll && scaled(t) >= kLeastScaledJacobian) || !move_nodes_of(t);
      });
    }
    return {moved(), slid()};
  }

 private:
  double scaled(TetIndex t) const {
    std::array<Vec3, 35> room;
    const std::span<const Vec3> nodes = nodes_of_tet(mesh_, t, room);
    if (least_scaled_jacobian_bound(mesh_.order(), nodes) > wanted_) return 1;
    const JacobianRange range = jacobian_range(mesh_.order(), nodes);
    return range.least / range.straight;
  }

  std::span<const VertexIndex> nodes_of(TetIndex t) const {
    return std::span<const VertexIndex>(mesh_.high_nodes).subspan(t * each_, each_);
  }

  void find_poor(std::span<const TetIndex> among) {
    std::vector<double> all(among.size());
    parallel_for(all.size(), [&](std::size_t i) { all[i] = scaled(among[i]); });
    std::vector<std::uint32_t> poor;
    for (std::uint32_t i = 0; i < all.size(); ++i)
      if (all[i] < wanted_) poor.push_back(i);
    std::ranges::stable_sort(poor, {}, [&](std::uint32_t i) { return all[i]; });
    const auto others =
        std::ranges::partition_point(poor, [&](std::uint32_t i) { return all[i] < kLeastScaledJacobian; });
    const std::size_t most = static_cast<std::size_t>(others - poor.begin()) + mesh_.tets.size() / kOthersOneIn;
    poor.resize(std::min(poor.size(), most));
    for (const std::uint32_t i : poor) poor_.push_back(among[i]);
  }

  /// The nodes of poor elements, and the elements at each.
  void gather() {
    place_.assign(mesh_.points.size(), kNone);
    for (const TetIndex t : poor_)
      for (const VertexIndex v : nodes_of(t)) {
        if (place_[v] != kNone) continue;
        place_[v] = static_cast<std::uint32_t>(from_.size());
        from_.emplace_back(v, mesh_.points[v]);
      }
    at_ = Groups<TetIndex>(static_cast<std::uint32_t>(from_.size()), [&](const auto& add) {
      for (TetIndex t = 0; t < mesh_.tets.size(); ++t)
        for (const VertexIndex v : nodes_of(t))
          if (const std::uint32_t place = place_[v]; place != kNone) add(place, t);
    });
  }

  /// Any of the elements that share an edge or face of a wall has the same polynomial there.
  void take_nodes_on_walls() {
    for (const auto& [v, from] : from_) {
      if (!on_wall_[v]) continue;
      const TetIndex t = at_[place_[v]].front();
      NodeOnWall node{{v, t, weights_of(v, t)}, old_nodes_.size()};
      std::array<Vec3, 35> room;
      const std::span<const Vec3> nodes = nodes_of_tet(mesh_, t, room);
      old_nodes_.insert(old_nodes_.end(), nodes.begin(), nodes.end());
      on_walls_.push_back(node);
    }
    std::ranges::sort(on_walls_, {}, &NodeOnWall::node);
  }

  std::array<double, 4> weights_of(VertexIndex v, TetIndex t) const {
    const auto k = static_cast<std::size_t>(std::ranges::find(nodes_of(t), v) - nodes_of(t).begin());
    const TetLattice::Weights& w = lattice_.weights(4 + k);
    return {double(w[0]), double(w[1]), double(w[2]), double(w[3])};
  }

  double shortest_edge(TetIndex t) const {
    double shortest = HUGE_VAL;
    for (const auto& [i, j] : kTetEdges)
      shortest = std::min(shortest, distance(mesh_.points[mesh_.tets[t][static_cast<std::size_t>(i)]],
                                             mesh_.points[mesh_.tets[t][static_cast<std::size_t>(j)]]));
    return shortest;
  }

  /// Whether any did.
  bool move_nodes_of(TetIndex t) {
    bool moves = false;
    const double step = kFirstStepOfNodes * shortest_edge(t);
    for (const VertexIndex v : nodes_of(t))
      if (!on_wall_[v]) moves |= move(v, step);
    if (walls_ == Walls::kStay) return moves;
    for (const VertexIndex v : nodes_of(t)) {
      if (!on_wall_[v]) continue;
      if (scaled(t) >= kLeastScaledJacobian) break;
      moves |= slide(*std::ranges::lower_bound(on_walls_, v, {}, &NodeOnWall::node));
    }
    return moves;
  }

  bool move(VertexIndex v, double step) {
    bool moves = false;
    look_at(v, wanted_);
    for (int i = 0; i < kStepsOfNodes && lacks_; ++i, step /= 2)
      for (int axis = 0; axis < 3; ++axis)
        for (const double by : {step, -step}) {
          Vec3 to = mesh_.points[v];
          to[axis] += by;
          if (!try_at(v, to, wanted_)) continue;
          moves = true;
          break;
        }
    return moves;
  }

  bool slide(NodeOnWall& node) {
    bool slides = false;
    const std::span<const Vec3> nodes = std::span<const Vec3>(old_nodes_).subspan(node.nodes, lattice_.size());
    look_at(node.node(), kLeastScaledJacobian);
    double step = kFirstStepOfNodes * mesh_.order();
    for (int n = 0; n < kStepsOfNodes && lacks_; ++n, step /= 2)
      for (const auto& [i, j] : kTetEdges)
        for (const double by : {step, -step}) {
          std::array<double, 4> at = node.now.at;
          if (at[i] == 0 || at[j] == 0) continue;
          at[i] += by, at[j] -= by;
          if (at[i] <= 0 || at[j] <= 0) continue;
          if (!try_at(node.node(), place_in_tet(mesh_.order(), nodes, at), kLeastScaledJacobian)) continue;
          node.now.at = at;
          slides = true;
          break;
        }
    return slides;
  }

  /// How the elements at a node are, as far as it matters.
  void look_at(VertexIndex v, double enough) {
    shapes_.clear();
    lacks_ = false;
    for (const TetIndex t : at_[place_[v]]) {
      shapes_.push_back(std::min(scaled(t), enough));
      lacks_ |= shapes_.back() < enough;
    }
  }

  /// The node stays there if no element at it becomes worse, and one better.
  bool try_at(VertexIndex v, Vec3 to, double enough) {
    const Vec3 before = mesh_.points[v];
    mesh_.points[v] = to;
    if (is_better_at(v, enough)) return true;
    mesh_.points[v] = before;
    return false;
  }

  bool is_better_at(VertexIndex v, double enough) {
    now_.clear();
    bool better = false, lacks = false;
    for (const TetIndex t : at_[place_[v]]) {
      const double now = std::min(scaled(t), enough), before = shapes_[now_.size()];
      if (now < before) return false;
      better |= now > before;
      lacks |= now < enough;
      now_.push_back(now);
    }
    if (better) lacks_ = lacks, shapes_.swap(now_);
    return better;
  }

  std::vector<std::pair<VertexIndex, Vec3>> moved() const {
    std::vector<std::pair<VertexIndex, Vec3>> by;
    for (const auto& [v, from] : from_)
      if (mesh_.points[v] != from) by.emplace_back(v, mesh_.points[v] - from);
    return by;
  }

  std::vector<SlidNode> slid() const {
    std::vector<SlidNode> slid;
    for (const NodeOnWall& node : on_walls_)
      if (node.now.at != weights_of(node.node(), node.now.tet)) slid.push_back(node.now);
    return slid;
  }

  TetMesh& mesh_;
  const TetLattice& lattice_;
  double wanted_;
  Walls walls_;
  std::size_t each_;
  std::vector<TetIndex> poor_;  ///< the worst first
  const std::vector<char>& on_wall_;
  std::vector<std::uint32_t> place_;                ///< per point: among those that may move
  std::vector<std::pair<VertexIndex, Vec3>> from_;  ///< these, and where they were
  Groups<TetIndex> at_;                             ///< of these
  std::vector<NodeOnWall> on_walls_;                ///< ascending
  std::vector<Vec3> old_nodes_;
  std::vector<double> shapes_, now_;  ///< of the elements at the node that is looked at
  bool lacks_ = false;                ///< one of them is not as is wanted
};

}  // namespace

NodesMoved raise_worst_elements(TetMesh& mesh, std::span<const TetIndex> among, double wanted,
                                const std::vector<char>& is_on_wall, Walls walls, const RunContext& context) {
  return MovingNodes(mesh, wanted, is_on_wall, walls).run(among, context);
}

}  // namespace octafront::curved
