#include "base/geometry/tet_lattice.h"

#include <octafront/tet_mesh.h>

namespace octafront {

TetLattice::TetLattice(int order) : order_(order), number_(16 * 16 * 16, 0) {
  const auto p = static_cast<std::int8_t>(order);
  if (order == 0) {
    add({0, 0, 0, 0});
    return;
  }
  for (std::size_t i = 0; i < 4; ++i) {
    Weights w{};
    w[i] = p;
    add(w);
  }
  add_inside_edges();
  add_inside_faces();
  add_inside();
}

void TetLattice::add(const Weights& w) {
  number_[key(w)] = static_cast<std::uint16_t>(weights_.size());
  weights_.push_back(w);
}

void TetLattice::add_inside_edges() {
  for (const auto& [a, b] : kTetEdges)
    for (int k = 1; k < order_; ++k) {
      Weights w{};
      w[static_cast<std::size_t>(a)] = static_cast<std::int8_t>(order_ - k);
      w[static_cast<std::size_t>(b)] = static_cast<std::int8_t>(k);
      add(w);
    }
}

void TetLattice::add_inside_faces() {
  for (const auto& [a, b, c] : kTetFaces)
    for (int i = order_ - 2; i > 0; --i)
      for (int j = order_ - i - 1; j > 0; --j) {
        Weights w{};
        w[static_cast<std::size_t>(a)] = static_cast<std::int8_t>(i);
        w[static_cast<std::size_t>(b)] = static_cast<std::int8_t>(j);
        w[static_cast<std::size_t>(c)] = static_cast<std::int8_t>(order_ - i - j);
        add(w);
      }
}

void TetLattice::add_inside() {
  for (int i = order_ - 3; i > 0; --i)
    for (int j = order_ - i - 2; j > 0; --j)
      for (int k = order_ - i - j - 1; k > 0; --k)
        add({static_cast<std::int8_t>(i), static_cast<std::int8_t>(j), static_cast<std::int8_t>(k),
             static_cast<std::int8_t>(order_ - i - j - k)});
}

const TetLattice& tet_lattice(int order) {
  static const std::array<TetLattice, 10> kAll{TetLattice(0), TetLattice(1), TetLattice(2), TetLattice(3),
                                               TetLattice(4), TetLattice(5), TetLattice(6), TetLattice(7),
                                               TetLattice(8), TetLattice(9)};
  return kAll[static_cast<std::size_t>(order)];
}

}  // namespace octafront
