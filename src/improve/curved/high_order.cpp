#include "improve/curved/high_order.h"

#include "base/core/parallel.h"
#include "base/geometry/curved_tet.h"
#include "base/geometry/tet_lattice.h"
#include "base/mesh/quadratic_nodes.h"
#include "improve/curved/bent_nodes.h"
#include "improve/curved/easing.h"
#include "improve/curved/moving_nodes.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace octafront::curved {

namespace {

/// An element that seems bad by its coefficients is halved into so many parts.
constexpr std::size_t kPartsOfBent = 64;
/// So often nodes move before what bends goes back without.
constexpr int kRoundsOfMoving = 8;
// Elements above this are left as they are, those above kLeastScaledJacobian by inner nodes' moves too.
constexpr double kWellShaped = 0.3;

class HighOrder {
 public:
  HighOrder(TetMesh& mesh, int order, const Bends& bends, Walls walls)
      : mesh_(mesh), walls_(walls), nodes_(mesh, order, bends) {}

  /// Until every element is good: nodes move, and where that is not enough what bends most goes back.
  void make_good(const RunContext& context) {
    if (nodes_.bent_tets().empty()) return;
    if (nodes_.order() > 3) go_on_from_third_order(context);
    const std::vector<char> is_on_wall = nodes_.is_on_wall();
    std::vector<TetIndex> suspects = nodes_.bent_tets();
    for (int round = 0; round < kRoundsOfMoving; ++round) {
      const bool has_moved = round > 0 || nodes_.order() > 3;
      const double wanted = has_moved ? kLeastScaledJacobian : kWellShaped;
      const NodesMoved moved = raise_worst_elements(mesh_, suspects, wanted, is_on_wall, walls_, context);
      nodes_.take(moved);
      const std::vector<std::uint32_t> back = spoiling(with_those_at(moved, suspects));
      if (back.empty()) return;
      suspects = go_back(back);
    }
    settle_tets(
        suspects, [&](TetIndex t) { return is_good(t); },
        [&](TetIndex t, std::vector<std::uint32_t>& back) { back.push_back(what_gives_way(t)); },
        [&](const std::vector<std::uint32_t>& back) { return go_back(back); }, context);
  }

  void count(SecondOrderSummary& summary) const {
    const auto eased = [](std::span<const Bent> bents) {
      return static_cast<std::size_t>(std::ranges::count_if(bents, &Bent::is_eased));
    };
    summary.edges = nodes_.edges().size();
    summary.eased = eased(nodes_.bents().first(nodes_.bent_edges()));
    summary.curved = nodes_.bent_edges() - summary.eased;
    summary.eased_faces = eased(nodes_.bents().subspan(nodes_.bent_edges(), nodes_.bent_faces()));
    summary.straight = summary.edges - summary.curved - summary.eased;
    for (std::uint32_t e = 0; e < nodes_.edges().size(); ++e)
      if (nodes_.bent_of_edge(e) != kNone) summary.largest_bend = std::max(summary.largest_bend, bend_of(e));
  }

 private:
  /// The same walls, nearly, with fewer nodes: what is good there is nearly good here.
  void go_on_from_third_order(const RunContext& context) {
    TetMesh low;
    low.points.assign(mesh_.points.begin(), mesh_.points.begin() + static_cast<std::ptrdiff_t>(nodes_.corners()));
    low.tets = mesh_.tets;
    low.boundary = mesh_.boundary, low.interfaces = mesh_.interfaces;
    HighOrder third(low, 3, nodes_.lowered(), walls_);
    third.make_good(context);
    nodes_.go_on_from(third.nodes_);
  }

  double bend_of(std::uint32_t e) const {
    double most = 0;
    for (std::size_t k = 0; k < nodes_in_edge(nodes_.order()); ++k)
      most = std::max(most, length(nodes_.off_edge(e, k)));
    return most / distance(mesh_.points[nodes_.edges().low[e]], mesh_.points[nodes_.edges().high[e]]);
  }

  /// And the elements that have nodes that moved, ascending.
  std::vector<TetIndex> with_those_at(const NodesMoved& moved, const std::vector<TetIndex>& others) const {
    std::vector<char> has_moved(mesh_.points.size()), is_one(mesh_.tets.size());
    for (const auto& [node, by] : moved.by) has_moved[node] = 1;
    for (const TetIndex t : others) is_one[t] = 1;
    const std::size_t each = mesh_.high_nodes_per_tet();
    for (std::size_t i = 0; i < mesh_.high_nodes.size(); ++i)
      if (has_moved[mesh_.high_nodes[i]]) is_one[i / each] = 1;
    std::vector<TetIndex> all;
    for (TetIndex t = 0; t < is_one.size(); ++t)
      if (is_one[t]) all.push_back(t);
    return all;
  }

  /// What gives way of each of these elements that is not good, each once, ascending.
  std::vector<std::uint32_t> spoiling(const std::vector<TetIndex>& tets) const {
    std::vector<char> good(tets.size());
    parallel_for(good.size(), [&](std::size_t i) { good[i] = is_good(tets[i]); });
    std::vector<std::uint32_t> back;
    for (std::size_t i = 0; i < good.size(); ++i)
      if (!good[i]) back.push_back(what_gives_way(tets[i]));
    std::ranges::sort(back);
    back.erase(std::unique(back.begin(), back.end()), back.end());
    return back;
  }

  bool is_good(TetIndex t) const {
    std::array<Vec3, 35> room;
    const int order = nodes_.order();
    const std::span<const Vec3> nodes = nodes_of_tet(mesh_, t, room);
    if (least_scaled_jacobian_bound(order, nodes) > kLeastScaledJacobian) return true;
    const JacobianRange range = jacobian_range(order, nodes);
    const double wanted = kLeastScaledJacobian * range.straight;
    return (range.least >= wanted || least_jacobian(order, nodes, kPartsOfBent) >= wanted) &&
           validity_of(order, nodes) == Validity::kValid;
  }

  /// What bends most of an element; where nothing bends, the moves of its nodes: a number beyond all that bend.
  std::uint32_t what_gives_way(TetIndex t) const {
    std::uint32_t most = kNone;
    const auto look = [&](std::uint32_t bent) {
      if (bent == kNone || nodes_.bents()[bent].left() == 0) return;
      if (most == kNone || nodes_.bents()[bent].left() > nodes_.bents()[most].left()) most = bent;
    };
    for (const std::uint32_t e : nodes_.edges_of_tet(t)) look(nodes_.bent_of_edge(e));
    for (const std::uint32_t f : nodes_.faces_of_tet(t)) look(nodes_.bent_of_face(f));
    look(nodes_.bent_of_tet(t));
    return most == kNone ? static_cast<std::uint32_t>(nodes_.bents().size()) + t : most;
  }

  /// Returns the tets that this changes.
  std::vector<TetIndex> go_back(const std::vector<std::uint32_t>& back) {
    const std::size_t bents = nodes_.bents().size();
    std::vector<char> changed(bents), edge_changed(nodes_.edges().size());
    for (const std::uint32_t i : back) {
      if (i < bents) {
        ++nodes_.bents()[i].halvings, changed[i] = 1;
        continue;
      }
      const auto t = static_cast<TetIndex>(i - bents);
      nodes_.forget_moves(t);
      for (const std::uint32_t e : nodes_.edges_of_tet(t)) edge_changed[e] = 1;
    }
    return place_again([&](std::uint32_t bent) { return bent != kNone && changed[bent]; }, edge_changed);
  }

  template <class HasChanged>
  std::vector<TetIndex> place_again(const HasChanged& has_changed, const std::vector<char>& edge_changed) {
    std::vector<TetIndex> touched;
    for (TetIndex t = 0; t < mesh_.tets.size(); ++t) {
      bool moves = has_changed(nodes_.bent_of_tet(t));
      for (const std::uint32_t e : nodes_.edges_of_tet(t))
        if (edge_changed[e] || has_changed(nodes_.bent_of_edge(e))) moves = true, nodes_.place_edge(e);
      for (const std::uint32_t f : nodes_.faces_of_tet(t)) moves |= has_changed(nodes_.bent_of_face(f));
      if (moves) touched.push_back(t);
    }
    for (const TetIndex t : touched)
      for (const std::uint32_t f : nodes_.faces_of_tet(t)) nodes_.place_face(f);
    for (const TetIndex t : touched) nodes_.place_tet(t);
    return touched;
  }

  TetMesh& mesh_;
  Walls walls_;
  BentNodes nodes_;
};

}  // namespace

void add_high_order(TetMesh& mesh, int order, std::span<const VertexIndex> below, Bends bends,
                    SecondOrderSummary& summary, const RunContext& context) {
  if (!below.empty()) {
    std::vector<std::array<std::uint32_t, 6>> edges_of_tet;
    add_edges_above(below, edges_of_tets(mesh.tets, mesh.points.size(), edges_of_tet), order, bends);
    add_faces_above(below, faces_of_tets(mesh.tets, mesh.points.size()), mesh, order, bends);
  }
  // What lies over walls would have to slide along with them.
  HighOrder high(mesh, order, bends, below.empty() ? Walls::kSlide : Walls::kStay);
  high.make_good(context);
  high.count(summary);
}

}  // namespace octafront::curved
