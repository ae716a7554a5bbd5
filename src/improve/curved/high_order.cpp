#include "improve/curved/high_order.h"

#include "base/core/parallel.h"
#include "base/geometry/curved_tet.h"
#include "base/geometry/tet_lattice.h"
#include "base/mesh/face_table.h"
#include "base/mesh/quadratic_nodes.h"
#include "improve/curved/easing.h"
#include "improve/curved/inner_nodes.h"
#include "improve/curved/mid_nodes.h"
#include "improve/curved/node_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace octafront::curved {

namespace {

/// An element that seems bad by its coefficients is halved into so many parts.
constexpr std::size_t kPartsOfBent = 64;
/// After so many of moving inner nodes edges and faces go back without them.
constexpr int kRoundsOfInnerNodes = 3;

/// How much each node inside an edge counts at a place where the barycentric coordinates of its ends are `low` and
/// `high`: low * high times the polynomial of high - low that is 1 / (low * high) at this node and 0 at the others.
std::array<double, 3> shares_of_edge(int order, double low, double high) {
  std::array<double, 3> shares{};
  const auto at = [&](int k) { return 2.0 * k / order - 1; };
  for (int k = 1; k < order; ++k) {
    double share = low * high * order * order / (k * (order - k));
    for (int i = 1; i < order; ++i)
      if (i != k) share *= (high - low - at(i)) / (at(k) - at(i));
    shares[static_cast<std::size_t>(k - 1)] = share;
  }
  return shares;
}

/// The same of the nodes inside a face: the product of its corners' coordinates, times a linear polynomial at order 4.
std::array<double, 3> shares_of_face(int order, const std::array<double, 3>& corners) {
  const double bubble = corners[0] * corners[1] * corners[2];
  if (order == 3) return {27 * bubble, 0, 0};
  std::array<double, 3> shares{};
  const double all = corners[0] + corners[1] + corners[2];
  for (std::size_t k = 0; k < 3; ++k) shares[k] = 32 * bubble * (4 * corners[k] - all);
  return shares;
}

/// An edge or face that bends: how, and how often it has gone halfway back.
struct Bent {
  NodeMoves by{};
  double most = 0;
  int halvings = 0;

  double part() const { return halvings < kMostHalvings ? std::ldexp(1, -halvings) : 0; }
};

Vec3 moved_by(const Bent& bent, const std::array<double, 3>& shares) {
  Vec3 sum;
  for (std::size_t k = 0; k < 3; ++k) sum += shares[k] * bent.by[k];
  return bent.part() * sum;
}

class HighOrder {
 public:
  HighOrder(TetMesh& mesh, int order, std::span<const VertexIndex> below, Bends bends)
      : mesh_(mesh),
        order_(order),
        corners_(mesh.points.size()),
        faces_(faces_of(mesh)),
        edges_(edges_of(mesh, edge_of_)) {
    first_in_face_ = corners_ + edges_.size() * nodes_in_edge(order);
    first_in_tet_ = first_in_face_ + faces_.corners.size() * nodes_in_face(order);
    mesh.points.resize(first_in_tet_ + mesh.tets.size() * nodes_in_tet(order));
    mesh.high_order = static_cast<std::uint32_t>(order);
    number_nodes();
    add_edges_above(below, edges_, order, bends);
    add_faces_above(below, faces_, mesh, order, bends);
    take(bends);
    find_bent_tets();
    place_all();
  }

  /// Until every element is good: inner nodes move, and where that is not enough what bends most goes back, a few times
  /// with all others where they were at first; then without them.
  void make_good(const RunContext& context) {
    for (int round = 0; round < kRoundsOfInnerNodes; ++round) {
      raise_worst_elements(mesh_, -HUGE_VAL, context);
      bool all_good = true;
      const std::vector<std::uint32_t> back = spoiling(all_good);
      if (all_good) return;
      for (const std::uint32_t i : back) ++bent_[i].halvings;
      place_all();
    }
    settle(context);
    raise_worst_elements(mesh_, kLeastScaledJacobian, context);
  }

  void count(SecondOrderSummary& summary) const {
    const std::size_t edges = bent_edges_;
    for (std::size_t i = 0; i < bent_.size(); ++i) {
      if (i < edges)
        ++(bent_[i].halvings == 0 ? summary.curved : summary.eased);
      else if (i < bent_faces_)
        summary.eased_faces += bent_[i].halvings > 0;
    }
    for (std::uint32_t e = 0; e < edges_.size(); ++e)
      if (bent_of_edge_[e] != kNone) {
        const Bent& bent = bent_[bent_of_edge_[e]];
        const double size = distance(mesh_.points[edges_.low[e]], mesh_.points[edges_.high[e]]);
        summary.largest_bend = std::max(summary.largest_bend, bent.part() * bent.most / size);
      }
    summary.edges = edges_.size();
    summary.straight = summary.edges - summary.curved - summary.eased;
  }

 private:
  void settle(const RunContext& context) {
    settle_tets(
        bent_tets_, [&](TetIndex t) { return is_good(t); },
        [&](TetIndex t, std::vector<std::uint32_t>& back) {
          if (const std::uint32_t most = most_bent(t); most != kNone) back.push_back(most);
        },
        [&](const std::vector<std::uint32_t>& back) { return go_back(back); }, context);
  }

  /// What bends most of each element that is not good, each once, ascending.
  std::vector<std::uint32_t> spoiling(bool& all_good) const {
    std::vector<char> good(mesh_.tets.size());
    parallel_for(good.size(), [&](std::size_t t) { good[t] = is_good(static_cast<TetIndex>(t)); });
    std::vector<std::uint32_t> back;
    for (TetIndex t = 0; t < good.size(); ++t) {
      if (good[t]) continue;
      all_good = false;
      if (const std::uint32_t most = most_bent(t); most != kNone) back.push_back(most);
    }
    std::ranges::sort(back);
    back.erase(std::unique(back.begin(), back.end()), back.end());
    return back;
  }

  void place_all() {
    parallel_for(edges_.size(), [&](std::size_t e) { place_edge(static_cast<std::uint32_t>(e)); });
    parallel_for(faces_.corners.size(), [&](std::size_t f) { place_face(static_cast<std::uint32_t>(f)); });
    parallel_for(mesh_.tets.size(), [&](std::size_t t) { place_tet(static_cast<TetIndex>(t)); });
  }

  VertexIndex node_in_edge(std::uint32_t e, std::size_t k) const {
    return static_cast<VertexIndex>(corners_ + e * nodes_in_edge(order_) + k);
  }
  VertexIndex node_in_face(std::uint32_t f, std::size_t k) const {
    return static_cast<VertexIndex>(first_in_face_ + f * nodes_in_face(order_) + k);
  }
  VertexIndex node_in_tet(TetIndex t, std::size_t k) const {
    return static_cast<VertexIndex>(first_in_tet_ + t * nodes_in_tet(order_) + k);
  }

  /// The nodes of each element in the order of the lattice, whichever way its edges and faces run.
  void number_nodes() {
    const std::size_t each = mesh_.high_nodes_per_tet();
    mesh_.high_nodes.resize(mesh_.tets.size() * each);
    parallel_for(mesh_.tets.size(), [&](std::size_t t) {
      const Tet& tet = mesh_.tets[t];
      VertexIndex* to = mesh_.high_nodes.data() + t * each;
      for (std::size_t e = 0; e < 6; ++e) {
        const bool runs =
            tet[static_cast<std::size_t>(kTetEdges[e][0])] < tet[static_cast<std::size_t>(kTetEdges[e][1])];
        const std::size_t inside = nodes_in_edge(order_);
        for (std::size_t k = 0; k < inside; ++k) *to++ = node_in_edge(edge_of_[t][e], runs ? k : inside - 1 - k);
      }
      for (std::size_t i = 0; i < 4; ++i) {
        const Triangle face = octafront::face_of(tet, static_cast<int>(i));
        const Triangle& sorted = faces_.corners[faces_.of_tet[t][i]];
        for (std::size_t k = 0; k < nodes_in_face(order_); ++k) {
          const auto corner = static_cast<std::size_t>(std::ranges::find(sorted, face[k]) - sorted.begin());
          *to++ = node_in_face(faces_.of_tet[t][i], order_ == 3 ? 0 : corner);
        }
      }
      for (std::size_t k = 0; k < nodes_in_tet(order_); ++k) *to++ = node_in_tet(static_cast<TetIndex>(t), k);
    });
  }

  void take(const Bends& bends) {
    bent_of_edge_.assign(edges_.size(), kNone);
    bent_of_face_.assign(faces_.corners.size(), kNone);
    for (const EdgeBend& bend : bends.edges) add(bend.by, bent_of_edge_[edges_.find(bend.edge[0], bend.edge[1])]);
    bent_edges_ = bent_.size();
    for (const FaceBend& bend : bends.faces) {
      const auto f =
          static_cast<std::uint32_t>(std::ranges::lower_bound(faces_.corners, bend.face) - faces_.corners.begin());
      NodeMoves by = bend.by;
      for (std::size_t k = 0; k < nodes_in_face(order_); ++k) by[k] -= moved_in_face(f, in_face(order_, k).weights);
      add(by, bent_of_face_[f]);
    }
    bent_faces_ = bent_.size();
    if (bends.tets.empty()) return;
    bent_of_tet_.assign(mesh_.tets.size(), kNone);
    for (const TetBend& bend : bends.tets) add({bend.by[0] - moved_in_tet(bend.tet)}, bent_of_tet_[bend.tet]);
  }

  /// What its edges and faces do to the middle of an element.
  Vec3 moved_in_tet(TetIndex t) const {
    Vec3 sum;
    for (const std::uint32_t e : edge_of_[t])
      if (const std::uint32_t bent = bent_of_edge_[e]; bent != kNone)
        sum += moved_by(bent_[bent], shares_of_edge(order_, 0.25, 0.25));
    for (const std::uint32_t f : faces_.of_tet[t])
      if (const std::uint32_t bent = bent_of_face_[f]; bent != kNone)
        sum += moved_by(bent_[bent], shares_of_face(order_, {0.25, 0.25, 0.25}));
    return sum;
  }
  std::uint32_t bent_of_tet(TetIndex t) const { return bent_of_tet_.empty() ? kNone : bent_of_tet_[t]; }

  void add(const NodeMoves& by, std::uint32_t& place) {
    double most = 0;
    for (const Vec3 move : by) most = std::max(most, length(move));
    if (most == 0) return;
    place = static_cast<std::uint32_t>(bent_.size());
    bent_.push_back({by, most});
  }

  /// What the edges of a face do to a place in it, which has these weights.
  Vec3 moved_in_face(std::uint32_t f, const std::array<double, 3>& weights) const {
    Vec3 sum;
    const Triangle& c = faces_.corners[f];
    for (const auto& [i, j] : {std::pair<std::size_t, std::size_t>{0, 1}, {0, 2}, {1, 2}})
      if (const std::uint32_t bent = bent_of_edge_[edges_.find(c[i], c[j])]; bent != kNone)
        sum += moved_by(bent_[bent], shares_of_edge(order_, weights[i] / order_, weights[j] / order_));
    return sum;
  }

  void find_bent_tets() {
    std::vector<char> bends(mesh_.tets.size());
    parallel_for(bends.size(), [&](std::size_t t) {
      for (const std::uint32_t e : edge_of_[t]) bends[t] |= bent_of_edge_[e] != kNone;
      for (const std::uint32_t f : faces_.of_tet[t]) bends[t] |= bent_of_face_[f] != kNone;
    });
    for (TetIndex t = 0; t < bends.size(); ++t)
      if (bends[t]) bent_tets_.push_back(t);
  }

  void place_edge(std::uint32_t e) {
    const Edge edge{edges_.low[e], edges_.high[e]};
    for (std::size_t k = 0; k < nodes_in_edge(order_); ++k) {
      Vec3 at = in_edge(order_, k).mean(mesh_.points, edge);
      if (const std::uint32_t bent = bent_of_edge_[e]; bent != kNone) at += bent_[bent].part() * bent_[bent].by[k];
      mesh_.points[node_in_edge(e, k)] = at;
    }
  }

  void place_face(std::uint32_t f) {
    for (std::size_t k = 0; k < nodes_in_face(order_); ++k) {
      const NodePlace<3> place = in_face(order_, k);
      Vec3 at = place.mean(mesh_.points, faces_.corners[f]) + moved_in_face(f, place.weights);
      if (const std::uint32_t bent = bent_of_face_[f]; bent != kNone) at += bent_[bent].part() * bent_[bent].by[k];
      mesh_.points[node_in_face(f, k)] = at;
    }
  }

  /// Order 4 has one node inside, in the middle.
  void place_tet(TetIndex t) {
    if (nodes_in_tet(order_) == 0) return;
    const Tet& tet = mesh_.tets[t];
    Vec3 at;
    for (const VertexIndex v : tet) at += 0.25 * mesh_.points[v];
    if (const std::uint32_t bent = bent_of_tet(t); bent != kNone) at += bent_[bent].part() * bent_[bent].by[0];
    mesh_.points[node_in_tet(t, 0)] = at + moved_in_tet(t);
  }

  bool is_good(TetIndex t) const {
    std::array<Vec3, 35> room;
    const std::span<const Vec3> nodes = nodes_of_tet(mesh_, t, room);
    if (least_scaled_jacobian_bound(order_, nodes) > kLeastScaledJacobian) return true;
    const JacobianRange range = jacobian_range(order_, nodes);
    const double wanted = kLeastScaledJacobian * range.straight;
    return (range.least >= wanted || least_jacobian(order_, nodes, kPartsOfBent) >= wanted) &&
           validity_of(order_, nodes) == Validity::kValid;
  }

  std::uint32_t most_bent(TetIndex t) const {
    std::uint32_t most = kNone;
    const auto look = [&](std::uint32_t bent) {
      if (bent == kNone || bent_[bent].part() == 0) return;
      if (most == kNone || left_of(bent) > left_of(most)) most = bent;
    };
    for (const std::uint32_t e : edge_of_[t]) look(bent_of_edge_[e]);
    for (const std::uint32_t f : faces_.of_tet[t]) look(bent_of_face_[f]);
    look(bent_of_tet(t));
    return most;
  }
  double left_of(std::uint32_t bent) const { return bent_[bent].part() * bent_[bent].most; }

  /// Returns the tets that this changes.
  std::vector<TetIndex> go_back(const std::vector<std::uint32_t>& back) {
    std::vector<TetIndex> touched;
    if (back.empty()) return touched;
    std::vector<char> changed(bent_.size());
    for (const std::uint32_t i : back) ++bent_[i].halvings, changed[i] = 1;
    const auto has_changed = [&](std::uint32_t bent) { return bent != kNone && changed[bent]; };
    std::vector<char> face_moves(faces_.corners.size());
    for (const TetIndex t : bent_tets_) {
      bool moves = false;
      for (const std::uint32_t e : edge_of_[t])
        if (has_changed(bent_of_edge_[e])) moves = true, place_edge(e);
      for (const std::uint32_t f : faces_.of_tet[t]) moves |= has_changed(bent_of_face_[f]);
      moves |= has_changed(bent_of_tet(t));
      if (moves) touched.push_back(t);
    }
    for (const TetIndex t : touched)
      for (const std::uint32_t f : faces_.of_tet[t]) face_moves[f] = 1;
    for (std::uint32_t f = 0; f < face_moves.size(); ++f)
      if (face_moves[f]) place_face(f);
    for (const TetIndex t : touched) place_tet(t);
    return touched;
  }

  TetMesh& mesh_;
  int order_;
  std::size_t corners_, first_in_face_ = 0, first_in_tet_ = 0;
  TetFaces faces_;
  std::vector<std::array<std::uint32_t, 6>> edge_of_;  ///< per tet
  TetEdges edges_;
  std::vector<Bent> bent_;                       ///< edges, then faces, then elements
  std::size_t bent_edges_ = 0, bent_faces_ = 0;  ///< so many; and those before elements
  std::vector<std::uint32_t> bent_of_edge_, bent_of_face_, bent_of_tet_;
  std::vector<TetIndex> bent_tets_;
};

}  // namespace

void add_high_order(TetMesh& mesh, int order, std::span<const VertexIndex> below, Bends bends,
                    SecondOrderSummary& summary, const RunContext& context) {
  HighOrder high(mesh, order, below, std::move(bends));
  high.make_good(context);
  high.count(summary);
}

}  // namespace octafront::curved
