#pragma once

// Where the nodes of a tetrahedron of order p lie: the points whose barycentric coordinates are multiples of 1/p.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace octafront {

inline constexpr int kMostOrder = 4;

/// How many nodes an edge, face or tetrahedron of this order has inside, and a tetrahedron altogether: 4, 10, 20, 35.
constexpr std::size_t nodes_in_edge(int order) {
  return static_cast<std::size_t>(order - 1);
}
constexpr std::size_t nodes_in_face(int order) {
  return static_cast<std::size_t>((order - 1) * (order - 2) / 2);
}
constexpr std::size_t nodes_in_tet(int order) {
  return static_cast<std::size_t>((order - 1) * (order - 2) * (order - 3) / 6);
}
constexpr std::size_t nodes_of_tet(int order) {
  return static_cast<std::size_t>((order + 1) * (order + 2) * (order + 3) / 6);
}

/// The nodes in our order: corners; of each edge of kTetEdges those inside from its first end to its second; of each
/// face of kTetFaces those inside, where one has most of an earlier corner before one that has less; those inside.
/// Weights are barycentric coordinates times p.
class TetLattice {
 public:
  using Weights = std::array<std::int8_t, 4>;

  explicit TetLattice(int order);

  int order() const { return order_; }
  std::size_t size() const { return weights_.size(); }
  const Weights& weights(std::size_t node) const { return weights_[node]; }
  /// The node that has these weights.
  std::size_t at(const Weights& w) const { return number_[key(w)]; }

 private:
  static std::size_t key(const Weights& w) {
    constexpr std::size_t kBase = 16;  // the Jacobian of order 4 is of degree 9
    return (static_cast<std::size_t>(w[0]) * kBase + static_cast<std::size_t>(w[1])) * kBase +
           static_cast<std::size_t>(w[2]);
  }
  void add(const Weights& w);
  void add_inside_edges();
  void add_inside_faces();
  void add_inside();

  int order_;
  std::vector<Weights> weights_;
  std::vector<std::uint16_t> number_;  ///< by key()
};

/// That of an order from 0 to 9, made once.
const TetLattice& tet_lattice(int order);

}  // namespace octafront
