#pragma once

#include "improve/curved/bends.h"
#include "improve/curved/easing.h"
#include "improve/curved/moving_nodes.h"
#include "improve/curved/node_numbers.h"

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace octafront::curved {

/// An edge, face or element that bends: how, and how often it has gone halfway back.
struct Bent {
  NodeMoves by{};
  double most = 0;
  bool was_eased = false;  ///< at order 3, from which this goes on
  int halvings = 0;

  bool is_eased() const { return was_eased || halvings > 0; }
  double part() const { return halvings < kMostHalvings ? std::ldexp(1, -halvings) : 0; }
  double left() const { return part() * most; }
};

/// The nodes of a mesh of order 3 or 4 where bends leave them: each lies where it does on straight edges and faces, or
/// where order 3 has it, and is moved from there by the edges, faces and the element that bend, and by what it moved
/// itself.
class BentNodes : public NumberedNodes {
 public:
  /// `bends` were found for this order.
  BentNodes(TetMesh& mesh, int order, const Bends& bends);

  /// Of order 4: goes on from what became of lowered() bends. Those that went back by some part there do here as well;
  /// where nodes slid along walls, others take the places between.
  void go_on_from(const BentNodes& third);
  /// The bends as order 3 has them.
  Bends lowered() const;

  /// Edges come first, then faces, then elements.
  std::span<Bent> bents() { return bent_; }
  std::span<const Bent> bents() const { return bent_; }
  std::size_t bent_edges() const { return bent_edges_; }
  std::size_t bent_faces() const { return bent_faces_ - bent_edges_; }
  std::uint32_t bent_of_edge(std::uint32_t e) const { return bent_of_edge_[e]; }
  std::uint32_t bent_of_face(std::uint32_t f) const { return bent_of_face_[f]; }
  std::uint32_t bent_of_tet(TetIndex t) const { return bent_of_tet_.empty() ? kNone : bent_of_tet_[t]; }
  /// Elements that have any of them but of their own, ascending.
  const std::vector<TetIndex>& bent_tets() const { return bent_tets_; }

  void take(const NodesMoved& moved);
  /// The nodes of an element have not moved; they are to be placed.
  void forget_moves(TetIndex t);

  void place_all();
  void place_edge(std::uint32_t e);
  void place_face(std::uint32_t f);
  void place_tet(TetIndex t);

 private:
  void add(const NodeMoves& by, std::uint32_t& place);
  void find_bent_tets();
  Vec3 moved_along(std::uint32_t e, double low, double high) const;
  Vec3 moved_in_face(std::uint32_t f, const std::array<double, 3>& at) const;
  Vec3 moved_in_tet(TetIndex t) const;
  Vec3 straight_in_tet(TetIndex t) const;
  Vec3 unbent(VertexIndex node, Vec3 straight) const;

  double part_of_edge(std::uint32_t e) const;
  double part_of_face(std::uint32_t f) const;
  double slid_on_edge(std::uint32_t e, std::size_t k) const;
  double slid_along(std::uint32_t e, double low, double high) const;
  Vec3 slid_by_edges(std::uint32_t f, const std::array<double, 3>& at) const;
  Vec3 slid_in_face(std::uint32_t f, const std::array<double, 3>& at) const;
  void take_as_base(const BentNodes& third);
  void aim_edges(const BentNodes& third, std::vector<NodeMoves>& by) const;
  void aim_faces(const BentNodes& third, std::vector<NodeMoves>& by) const;

  std::vector<Bent> bent_;
  std::size_t bent_edges_ = 0, bent_faces_ = 0;  ///< so many; and those before elements
  std::vector<std::uint32_t> bent_of_edge_, bent_of_face_, bent_of_tet_;
  std::vector<TetIndex> bent_tets_;
  std::vector<Vec3> base_;      ///< of nodes behind corners, where they are without bends; none: on straight ones
  std::vector<Vec3> moved_;     ///< of nodes behind corners, by themselves; none: nowhere
  std::vector<SlidNode> slid_;  ///< ascending by node, which may be there several times
};

}  // namespace octafront::curved
