#include "formats/parts/netgen_curves.h"

#include "base/mesh/face_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace octafront::io {
namespace {

/// As many as an edge or face of order 4 has.
using Shapes = std::array<double, 3>;

/// Integrated Legendre polynomials of low - high, made homogeneous by low + high.
Shapes edge_shapes(double low, double high) {
  const double x = low - high, t = low + high;
  const double second = (x * x - t * t) / 2, third = x * second;
  return {second, third, 1.25 * x * third - 0.25 * t * t * second};
}

/// Jacobi polynomials over the bubble of a face, whose vertices ascend. The second one is not homogeneous; so is
/// Netgen's.
Shapes face_shapes(double a, double b, double c) {
  const double bubble = 4 * a * b * c, t = a + b + c;
  return {bubble, bubble * (1.5 * t + 4.5 * (2 * c - 1)), bubble * 3 * (b - a)};
}

template <std::size_t kCorners>
std::array<std::size_t, kCorners> ascending(const Tet& t, std::array<int, kCorners> corners) {
  std::ranges::sort(corners, {}, [&](int c) { return t[static_cast<std::size_t>(c)]; });
  std::array<std::size_t, kCorners> places;
  std::ranges::copy(corners, places.begin());
  return places;
}

/// Values of so many shapes at the inner nodes of an edge or face, inverted: from nodes to coefficients.
template <class ShapesAt>
SquareMatrix from_nodes(std::size_t count, const ShapesAt& shapes_at) {
  SquareMatrix values(count, std::vector<double>(count));
  for (std::size_t k = 0; k < count; ++k) std::copy_n(shapes_at(k).begin(), count, values[k].begin());
  return inverse_of(std::move(values));
}

/// Weights of the inner nodes of an edge, from the lower vertex on, and of a face, by the vertex that they are near to.
TetLattice::Weights inner_weights(const std::array<std::size_t, 2>& ends, int order, std::size_t k) {
  TetLattice::Weights w{};
  w[ends[1]] = static_cast<std::int8_t>(k + 1);
  w[ends[0]] = static_cast<std::int8_t>(order - 1 - static_cast<int>(k));
  return w;
}
TetLattice::Weights inner_weights(const std::array<std::size_t, 3>& corners, int order, std::size_t k) {
  TetLattice::Weights w{};
  for (const std::size_t c : corners) w[c] = 1;
  w[corners[k]] = static_cast<std::int8_t>(order - 2);
  return w;
}

std::array<double, 4> barycentric(const TetLattice::Weights& w, int order) {
  std::array<double, 4> at;
  for (std::size_t c = 0; c < 4; ++c) at[c] = static_cast<double>(w[c]) / order;
  return at;
}

NetgenCurves::Part straight_part(NumberedParts numbers) {
  const std::size_t count = numbers.first.size();
  return {std::move(numbers), std::vector<std::int64_t>(count, 1), std::vector<std::int64_t>(count + 1, 0), {}};
}

/// Adds what is off at the nodes; nothing where that is rounding of coordinates.
void add_part(NetgenCurves::Part& part, std::size_t n, int order, std::span<const Vec3> off, double largest,
              const SquareMatrix& matrix) {
  constexpr double kRounding = 8 * std::numeric_limits<double>::epsilon();
  const bool is_curved = std::ranges::any_of(off, [&](const Vec3& v) { return length(v) > kRounding * largest; });
  if (is_curved) {
    part.order[n] = order;
    for (const auto& row : matrix) {
      Vec3 sum;
      for (std::size_t k = 0; k < off.size(); ++k) sum += row[k] * off[k];
      part.coefficients.push_back(sum);
    }
  }
  part.first[n + 1] = static_cast<std::int64_t>(part.coefficients.size());
}

}  // namespace

NetgenCurves::NetgenCurves(std::span<const Tet> given, std::size_t vertices)
    : tets(given),
      edges(straight_part(numbered_edges(given, vertices, PartOrder::kSorted))),
      faces(straight_part(numbered_faces(given, vertices, PartOrder::kSorted))) {}

NetgenCurves::NetgenCurves(std::span<const Tet> given, std::size_t vertices, int order,
                           FunctionRef<Vec3(TetIndex, std::size_t)> node_at)
    : NetgenCurves(given, vertices) {
  const TetLattice& lattice = tet_lattice(order);
  double largest = 0;
  for (TetIndex t = 0; t < tets.size(); ++t)
    for (std::size_t k = 0; k < 4; ++k)
      for (int axis = 0; axis < 3; ++axis) largest = std::max(largest, std::abs(node_at(t, k)[axis]));
  const auto straight = [&](TetIndex t, const std::array<double, 4>& at) {
    Vec3 sum;
    for (std::size_t c = 0; c < 4; ++c) sum += at[c] * node_at(t, c);
    return sum;
  };
  std::array<Vec3, 3> off;
  const auto take = [&](TetIndex t, const auto& corners, std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) {
      const TetLattice::Weights w = inner_weights(corners, order, k);
      const std::array<double, 4> at = barycentric(w, order);
      off[k] = node_at(t, lattice.at(w)) - straight(t, at) - (corners.size() == 3 ? of_edges(t, at) : Vec3{});
    }
    return std::span<const Vec3>(off).first(count);
  };
  const std::size_t in_edge = nodes_in_edge(order), in_face = nodes_in_face(order);
  const SquareMatrix of_edge = from_nodes(in_edge, [&](std::size_t k) {
    const double high = static_cast<double>(k + 1) / order;
    return edge_shapes(1 - high, high);
  });
  for (std::uint32_t n = 0; n < edges.numbers.first.size(); ++n) {
    const std::uint32_t t = edges.numbers.first[n] / 6, e = edges.numbers.first[n] % 6;
    add_part(edges, n, order, take(t, ascending(tets[t], kTetEdges[e]), in_edge), largest, of_edge);
  }
  const SquareMatrix of_face = from_nodes(in_face, [&](std::size_t k) {
    const std::array<double, 4> at = barycentric(inner_weights(std::array<std::size_t, 3>{0, 1, 2}, order, k), order);
    return face_shapes(at[0], at[1], at[2]);
  });
  for (std::uint32_t n = 0; in_face > 0 && n < faces.numbers.first.size(); ++n) {
    const std::uint32_t t = faces.numbers.first[n] / 4, f = faces.numbers.first[n] % 4;
    add_part(faces, n, order, take(t, ascending(tets[t], kTetFaces[f]), in_face), largest, of_face);
  }
}

Vec3 NetgenCurves::of_edges(TetIndex t, const std::array<double, 4>& at) const {
  Vec3 sum;
  for (std::size_t e = 0; e < kTetEdges.size(); ++e) {
    const std::uint32_t n = edges.numbers.of[6 * std::size_t{t} + e];
    const auto [low, high] = ascending(tets[t], kTetEdges[e]);
    if (edges.order[n] < 2 || at[low] == 0 || at[high] == 0) continue;
    const Shapes shapes = edge_shapes(at[low], at[high]);
    const auto first = static_cast<std::size_t>(edges.first[n]);
    for (std::size_t j = 0; j + 1 < static_cast<std::size_t>(edges.order[n]); ++j)
      sum += shapes[j] * edges.coefficients[first + j];
  }
  return sum;
}

Vec3 NetgenCurves::added(TetIndex t, const std::array<double, 4>& at) const {
  Vec3 sum = of_edges(t, at);
  for (std::size_t f = 0; f < kTetFaces.size(); ++f) {
    const std::uint32_t n = faces.numbers.of[4 * std::size_t{t} + f];
    const auto [a, b, c] = ascending(tets[t], kTetFaces[f]);
    if (faces.order[n] < 3 || at[a] == 0 || at[b] == 0 || at[c] == 0) continue;
    const Shapes shapes = face_shapes(at[a], at[b], at[c]);
    const auto first = static_cast<std::size_t>(faces.first[n]);
    const auto count = static_cast<std::size_t>(netgen_coefficients(faces.order[n], false));
    for (std::size_t j = 0; j < count; ++j) sum += shapes[j] * faces.coefficients[first + j];
  }
  return sum;
}

}  // namespace octafront::io
