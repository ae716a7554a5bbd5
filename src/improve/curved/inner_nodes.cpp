#include "improve/curved/inner_nodes.h"

#include <octafront/run_context.h>

#include "base/core/groups.h"
#include "base/core/parallel.h"
#include "base/geometry/curved_tet.h"
#include "base/geometry/tet_lattice.h"
#include "base/mesh/face_table.h"
#include "base/mesh/quadratic_nodes.h"
#include "improve/curved/easing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace octafront::curved {

namespace {

// Elements above this are left as they are.
constexpr double kWellShaped = 0.3;
constexpr int kSweepsOfNodes = 2;
// Milliseconds each: all that edges and faces would have to go back for, and of the others one in so many elements.
constexpr std::size_t kOthersOneIn = 200;
/// Steps in parts of the shortest edge of the element: a try with each, then half of it.
constexpr double kFirstStepOfNodes = 0.1;
constexpr int kStepsOfNodes = 4;

class InnerNodes {
 public:
  InnerNodes(TetMesh& mesh, double least) : mesh_(mesh), least_(least), each_(mesh.high_nodes_per_tet()) {}

  void run(const RunContext& context) {
    find_poor();
    if (poor_.empty()) return;
    find_fixed();
    gather();
    for (int sweep = 0; sweep < kSweepsOfNodes; ++sweep) {
      std::erase(poor_, kNone);
      for (TetIndex& t : poor_) {
        context.check();
        bool moves = false;
        for (std::size_t k = 0; k < each_; ++k)
          if (const VertexIndex v = mesh_.high_nodes[t * each_ + k]; !is_fixed_[v]) moves |= move(v, shortest_edge(t));
        // Where nothing moved nothing will.
        if (!moves) t = kNone;
      }
    }
  }

 private:
  double scaled(TetIndex t) const {
    std::array<Vec3, 35> room;
    const std::span<const Vec3> nodes = nodes_of_tet(mesh_, t, room);
    if (least_scaled_jacobian_bound(mesh_.order(), nodes) > kWellShaped) return 1;
    const JacobianRange range = jacobian_range(mesh_.order(), nodes);
    return range.least / range.straight;
  }

  void find_poor() {
    std::vector<double> all(mesh_.tets.size());
    parallel_for(all.size(), [&](std::size_t t) { all[t] = scaled(static_cast<TetIndex>(t)); });
    for (TetIndex t = 0; t < all.size(); ++t)
      if (all[t] < kWellShaped) poor_.push_back(t);
    std::ranges::stable_sort(poor_, {}, [&](TetIndex t) { return all[t]; });
    const auto others = std::ranges::partition_point(poor_, [&](TetIndex t) { return all[t] < kLeastScaledJacobian; });
    const std::size_t most = static_cast<std::size_t>(others - poor_.begin()) + mesh_.tets.size() / kOthersOneIn;
    poor_.resize(std::min(poor_.size(), most));
  }

  /// Nodes on walls.
  void find_fixed() {
    is_fixed_.assign(mesh_.points.size(), 0);
    std::vector<Triangle> walls;
    for (const auto* faces : {&mesh_.boundary, &mesh_.interfaces})
      for (const Triangle& t : *faces) walls.push_back(face_key(t));
    std::ranges::sort(walls);
    const TetLattice& lattice = tet_lattice(mesh_.order());
    for (TetIndex t = 0; t < mesh_.tets.size(); ++t)
      for (std::size_t i = 0; i < 4; ++i) {
        if (!std::ranges::binary_search(walls, face_key(octafront::face_of(mesh_.tets[t], static_cast<int>(i)))))
          continue;
        for (std::size_t k = 0; k < each_; ++k)
          if (lattice.weights(4 + k)[i] == 0) is_fixed_[mesh_.high_nodes[t * each_ + k]] = 1;
      }
  }

  /// The elements at the nodes that may move.
  void gather() {
    place_.assign(mesh_.points.size(), kNone);
    std::uint32_t nodes = 0;
    for (const TetIndex t : poor_)
      for (std::size_t k = 0; k < each_; ++k)
        if (const VertexIndex v = mesh_.high_nodes[t * each_ + k]; !is_fixed_[v] && place_[v] == kNone)
          place_[v] = nodes++;
    at_ = Groups<TetIndex>(nodes, [&](const auto& add) {
      for (TetIndex t = 0; t < mesh_.tets.size(); ++t)
        for (std::size_t k = 0; k < each_; ++k)
          if (const std::uint32_t place = place_[mesh_.high_nodes[t * each_ + k]]; place != kNone) add(place, t);
    });
  }

  double shortest_edge(TetIndex t) const {
    double shortest = HUGE_VAL;
    for (const auto& [i, j] : kTetEdges)
      shortest = std::min(shortest, distance(mesh_.points[mesh_.tets[t][static_cast<std::size_t>(i)]],
                                             mesh_.points[mesh_.tets[t][static_cast<std::size_t>(j)]]));
    return shortest;
  }

  /// The least of the elements at a node; of one that is not above `enough` no other is asked, and it is asked first
  /// the next time.
  double worst_at(VertexIndex v, double enough) {
    const std::span<TetIndex> tets = at_[place_[v]];
    double worst = 1;
    for (TetIndex& t : tets) {
      worst = std::min(worst, scaled(t));
      if (worst > enough) continue;
      std::swap(t, tets.front());
      break;
    }
    return worst;
  }

  /// Whether it did.
  bool move(VertexIndex v, double edge) {
    bool moves = false;
    double worst = worst_at(v, -HUGE_VAL), step = kFirstStepOfNodes * edge;
    if (worst < least_) return false;
    for (int i = 0; i < kStepsOfNodes && worst < kWellShaped; ++i, step /= 2)
      for (int axis = 0; axis < 3; ++axis)
        for (const double by : {step, -step}) {
          const Vec3 before = mesh_.points[v];
          mesh_.points[v][axis] += by;
          const double now = worst_at(v, worst);
          if (now > worst) {
            worst = now;
            moves = true;
            break;
          }
          mesh_.points[v] = before;
        }
    return moves;
  }

  TetMesh& mesh_;
  double least_;
  std::size_t each_;
  std::vector<TetIndex> poor_;  ///< the worst first
  std::vector<char> is_fixed_;
  std::vector<std::uint32_t> place_;  ///< per point
  Groups<TetIndex> at_;
};

}  // namespace

void raise_worst_elements(TetMesh& mesh, double least, const RunContext& context) {
  InnerNodes(mesh, least).run(context);
}

}  // namespace octafront::curved
