#include "formats/parts/mfem_nodes.h"

#include "base/geometry/curved_tet.h"
#include "base/geometry/tet_lattice.h"
#include "base/mesh/face_table.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace octafront::io {
namespace {

/// Places from 0 to 1, order + 1 of them.
std::vector<double> places_in_line(MfemPoints points, int order) {
  // Of those between -1 and 1 that are not below 0: zeros of Legendre's polynomial; 1 and those of its derivative.
  const auto open = [&]() -> std::vector<double> {
    if (order == 1) return {std::sqrt(1.0 / 3)};
    if (order == 2) return {0, std::sqrt(.6)};
    if (order == 3) return {std::sqrt((3 - 2 * std::sqrt(1.2)) / 7), std::sqrt((3 + 2 * std::sqrt(1.2)) / 7)};
    return {0, std::sqrt(5 - 2 * std::sqrt(10.0 / 7)) / 3, std::sqrt(5 + 2 * std::sqrt(10.0 / 7)) / 3};
  };
  const auto closed = [&]() -> std::vector<double> {
    if (order == 1) return {1};
    if (order == 2) return {0, 1};
    if (order == 3) return {std::sqrt(.2), 1};
    return {0, std::sqrt(3.0 / 7), 1};
  };
  std::vector<double> all;
  if (points == MfemPoints::kUniform) {
    for (int k = 0; k <= order; ++k) all.push_back(static_cast<double>(k) / order);
    return all;
  }
  for (const double x : points == MfemPoints::kGaussLegendre ? open() : closed()) {
    if (x > 0) all.push_back((1 - x) / 2);
    all.push_back((1 + x) / 2);
  }
  std::ranges::sort(all);
  return all;
}

/// Values of our nodes' polynomials (columns) at the places of nodes of that kind (rows).
SquareMatrix at_nodes(MfemPoints points, int order) {
  const TetLattice& lattice = tet_lattice(order);
  const std::vector<double> line = places_in_line(points, order);
  SquareMatrix rows(lattice.size(), std::vector<double>(lattice.size()));
  for (std::size_t k = 0; k < lattice.size(); ++k) {
    std::vector<Vec3> unit(lattice.size());
    unit[k] = {1, 0, 0};
    for (std::size_t i = 0; i < lattice.size(); ++i) {
      std::array<double, 4> at;
      for (std::size_t c = 0; c < 4; ++c) at[c] = line[static_cast<std::size_t>(lattice.weights(i)[c])];
      const double sum = at[0] + at[1] + at[2] + at[3];
      for (double& a : at) a *= order / sum;
      rows[i][k] = place_in_tet(order, unit, at).x;
    }
  }
  return rows;
}

/// Values of Bernstein's polynomials (columns) at our nodes (rows).
SquareMatrix of_bernstein(int order) {
  const TetLattice& lattice = tet_lattice(order);
  constexpr std::array<double, kMostOrder + 1> kFactorial{1, 1, 2, 6, 24};
  const auto power = [](double base, int times) {
    double product = 1;
    while (times-- > 0) product *= base;
    return product;
  };
  SquareMatrix rows(lattice.size(), std::vector<double>(lattice.size()));
  for (std::size_t i = 0; i < lattice.size(); ++i)
    for (std::size_t k = 0; k < lattice.size(); ++k) {
      double value = kFactorial[static_cast<std::size_t>(order)];
      for (std::size_t c = 0; c < 4; ++c) {
        const auto times = lattice.weights(k)[c];
        value *= power(static_cast<double>(lattice.weights(i)[c]) / order, times);
        value /= kFactorial[static_cast<std::size_t>(times)];
      }
      rows[i][k] = value;
    }
  return rows;
}

}  // namespace

MfemNumbering::MfemNumbering(std::span<const Tet> tets, std::size_t vertices, int order)
    : tets_(tets), vertices_(vertices), order_(order), size_(vertices) {
  if (order < 2) return;
  edges_ = numbered_edges(tets, vertices, PartOrder::kAsNamed);
  in_edges_ = vertices + edges_.first.size() * nodes_in_edge(order);
  faces_ = numbered_faces(tets, vertices, PartOrder::kAsNamed);
  in_faces_ = in_edges_ + faces_.first.size() * nodes_in_face(order);
  size_ = in_faces_ + tets.size() * nodes_in_tet(order);
}

void MfemNumbering::of_tet(TetIndex t, std::span<VertexIndex> nodes) const {
  std::size_t next = 0;
  for (const VertexIndex v : tets_[t]) nodes[next++] = v;
  if (order_ < 2) return;
  for (std::size_t e = 0; e < kTetEdges.size(); ++e)
    for (std::size_t k = 0; k < nodes_in_edge(order_); ++k) nodes[next++] = in_edge(t, e, k);
  for (std::size_t f = 0; f < kTetFaces.size(); ++f)
    for (std::size_t k = 0; k < nodes_in_face(order_); ++k) nodes[next++] = in_face(t, f, k);
  for (std::size_t k = 0; k < nodes_in_tet(order_); ++k)
    nodes[next++] = static_cast<VertexIndex>(in_faces_ + t * nodes_in_tet(order_) + k);
}

VertexIndex MfemNumbering::in_edge(TetIndex t, std::size_t edge, std::size_t k) const {
  const auto& [a, b] = kTetEdges[edge];
  const bool ascends = tets_[t][static_cast<std::size_t>(a)] < tets_[t][static_cast<std::size_t>(b)];
  const std::size_t each = nodes_in_edge(order_), at = ascends ? k : each - 1 - k;
  return static_cast<VertexIndex>(vertices_ + edges_.of[6 * std::size_t{t} + edge] * each + at);
}

VertexIndex MfemNumbering::in_face(TetIndex t, std::size_t face, std::size_t k) const {
  const std::size_t each = nodes_in_face(order_);
  const std::uint32_t number = faces_.of[4 * std::size_t{t} + face], first = faces_.first[number];
  std::size_t at = k;
  if (each > 1) {
    const Triangle as_named = face_of(tets_[first / 4], static_cast<int>(first % 4));
    const VertexIndex nearest = face_of(tets_[t], static_cast<int>(face))[k];
    at = static_cast<std::size_t>(std::ranges::find(as_named, nearest) - as_named.begin());
  }
  return static_cast<VertexIndex>(in_edges_ + number * each + at);
}

std::vector<double> matrix_from_mfem(MfemPoints points, int order) {
  const bool are_ends_and_middles = points == MfemPoints::kGaussLobatto && order <= 2;
  if (points == MfemPoints::kUniform || are_ends_and_middles) return {};
  const SquareMatrix rows =
      points == MfemPoints::kBernstein ? of_bernstein(order) : inverse_of(at_nodes(points, order));
  std::vector<double> flat;
  for (const auto& row : rows) flat.insert(flat.end(), row.begin(), row.end());
  return flat;
}

}  // namespace octafront::io
