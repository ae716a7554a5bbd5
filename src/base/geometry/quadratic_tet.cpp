#include "base/geometry/quadratic_tet.h"

#include "base/geometry/expansion.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace octafront {

namespace {

// With Q_ij the mid-side node of edge ij, and Q_ii = P_i, column c = 1, 2, 3 of the Jacobian at corner i is
//   g_ic = 4 (Q_ic - Q_i0) - (P_c - P_0),
// and inside the element it is linear. The coefficient i, j, k is the mean of det(g_a1, g_b2, g_c3) over the
// permutations a, b, c of i, j, k.
constexpr int kNode[4][4] = {{0, 4, 5, 6}, {4, 1, 7, 8}, {5, 7, 2, 9}, {6, 8, 9, 3}};

struct Index {
  int i, j, k;
};

template <class Visit>
void for_coefficients(const Visit& visit) {
  int number = 0;
  for (int i = 0; i < 4; ++i)
    for (int j = i; j < 4; ++j)
      for (int k = j; k < 4; ++k) visit(number++, Index{i, j, k});
}

Vec3 absolute(Vec3 a) {
  return {std::abs(a.x), std::abs(a.y), std::abs(a.z)};
}
// The cross product of magnitudes: what bounds the rounding errors of the true one.
Vec3 magnitude_cross(Vec3 a, Vec3 b) {
  return {a.y * b.z + a.z * b.y, a.z * b.x + a.x * b.z, a.x * b.y + a.y * b.x};
}

/// Columns at the corners, and pairs of them multiplied: everything of which the coefficients are sums.
struct Terms {
  Vec3 first[4];    // g_i1
  Vec3 pair[4][4];  // g_j2 x g_k3
  double of(const Index& n) const {
    const auto [i, j, k] = n;
    if (i == k) return dot(first[i], pair[i][i]);
    if (i == j) return (dot(first[k], pair[i][i]) + dot(first[i], pair[i][k] + pair[k][i])) / 3;
    if (j == k) return (dot(first[i], pair[k][k]) + dot(first[k], pair[i][k] + pair[k][i])) / 3;
    return (dot(first[i], pair[j][k] + pair[k][j]) + dot(first[j], pair[i][k] + pair[k][i]) +
            dot(first[k], pair[i][j] + pair[j][i])) /
           6;
  }
};

Terms values(const QuadraticTet& q) {
  Vec3 g[3][4];
  for (int c = 1; c < 4; ++c)
    for (int i = 0; i < 4; ++i) g[c - 1][i] = 4 * (q[kNode[i][c]] - q[kNode[i][0]]) - (q[c] - q[0]);
  Terms t;
  for (int j = 0; j < 4; ++j) {
    t.first[j] = g[0][j];
    for (int k = 0; k < 4; ++k) t.pair[j][k] = cross(g[1][j], g[2][k]);
  }
  return t;
}

Terms magnitudes(const QuadraticTet& q) {
  Vec3 g[3][4];
  for (int c = 1; c < 4; ++c)
    for (int i = 0; i < 4; ++i) g[c - 1][i] = 4 * absolute(q[kNode[i][c]] - q[kNode[i][0]]) + absolute(q[c] - q[0]);
  Terms t;
  for (int j = 0; j < 4; ++j) {
    t.first[j] = g[0][j];
    for (int k = 0; k < 4; ++k) t.pair[j][k] = magnitude_cross(g[1][j], g[2][k]);
  }
  return t;
}

// An entry of a column errs by 2 eps of its magnitude, eps = 2^-53; a product of three entries by 6 + 2; nine additions
// and a division follow at most. Twice that, for what is of second order and for the magnitudes' own rounding.
constexpr double kRounding = 2 * 18 * 0x1p-53;

using Entry = exact::Expansion<4>;
using Column = std::array<Entry, 3>;

Entry times_four(const exact::Expansion<2>& e) {
  Entry r;
  for (int i = 0; i < e.size; ++i) r.push(4 * e.term[i]);
  return r;
}

Entry sum_of(const Entry& a, const exact::Expansion<2>& b) {
  const auto wide = a + b;  // no more than two terms in either
  Entry r;
  for (int i = 0; i < wide.size; ++i) r.push(wide.term[i]);
  return r;
}

Column exact_column(const QuadraticTet& q, int i, int c) {
  Column column;
  for (int axis = 0; axis < 3; ++axis)
    column[axis] = sum_of(times_four(exact::difference(q[kNode[i][c]][axis], q[kNode[i][0]][axis])),
                          exact::difference(q[0][axis], q[c][axis]));
  return column;
}

auto determinant_of_columns(const Column& a, const Column& b, const Column& c) {
  const auto x = a[0] * (b[1] * c[2] - b[2] * c[1]);
  const auto y = a[1] * (b[2] * c[0] - b[0] * c[2]);
  const auto z = a[2] * (b[0] * c[1] - b[1] * c[0]);
  return x + y + z;
}

/// The sign of one coefficient: that of the sum over all six permutations, whether some are equal or not.
int exact_sign(const QuadraticTet& q, const Index& n) {
  const auto det = [&](int a, int b, int c) {
    return determinant_of_columns(exact_column(q, a, 1), exact_column(q, b, 2), exact_column(q, c, 3));
  };
  const auto [i, j, k] = n;
  return ((det(i, j, k) + det(j, k, i) + det(k, i, j)) + (det(i, k, j) + det(k, j, i) + det(j, i, k))).sign();
}

}  // namespace

std::array<double, 20> jacobian_coefficients(const QuadraticTet& nodes) {
  const Terms terms = values(nodes);
  std::array<double, 20> coefficients;
  for_coefficients([&](int number, const Index& n) { coefficients[static_cast<std::size_t>(number)] = terms.of(n); });
  return coefficients;
}

double least_scaled_jacobian_bound(const QuadraticTet& q) {
  // With d_ij = Q_ij - (P_i + P_j) / 2 a column is P_c - P_0 + 4 (d_ic - d_i0), so it is off the straight one by 8
  // times the longest d at most; the determinant by what Hadamard's inequality makes of that.
  const Vec3 u = q[1] - q[0], v = q[2] - q[0], w = q[3] - q[0];
  const Vec3 bends[6] = {q[4] - q[0] - 0.5 * u,       q[5] - q[0] - 0.5 * v,       q[6] - q[0] - 0.5 * w,
                         q[7] - q[0] - 0.5 * (u + v), q[8] - q[0] - 0.5 * (u + w), q[9] - q[0] - 0.5 * (v + w)};
  double squared = 0;
  for (const Vec3 d : bends) squared = std::max(squared, squared_length(d));
  const double lu = length(u), lv = length(v), lw = length(w), straight = dot(u, cross(v, w));
  constexpr double kRoundingOfBends = 64 * 0x1p-53;  // eight times some five roundings of terms below 1.5 edges
  const double off = 8 * std::sqrt(squared) + kRoundingOfBends * (lu + lv + lw);
  const double most = (lu + off) * (lv + off) * (lw + off), change = most - lu * lv * lw + kRounding * most;
  return straight > 0 ? 1 - change / straight : -std::numeric_limits<double>::infinity();
}

double jacobian_determinant(const QuadraticTet& q, const std::array<double, 4>& place) {
  Vec3 column[3];
  for (int c = 1; c < 4; ++c)
    for (int i = 0; i < 4; ++i)
      column[c - 1] += place[static_cast<std::size_t>(i)] * (4 * (q[kNode[i][c]] - q[kNode[i][0]]) - (q[c] - q[0]));
  return dot(column[0], cross(column[1], column[2]));
}

bool has_positive_jacobian(const QuadraticTet& nodes) {
  if (least_scaled_jacobian_bound(nodes) > kRounding) return true;
  const Terms terms = values(nodes), bounds = magnitudes(nodes);
  bool positive = true;
  for_coefficients([&](int, const Index& n) {
    if (!positive) return;
    const double value = terms.of(n), bound = kRounding * bounds.of(n);
    positive = value > bound || (value >= -bound && exact_sign(nodes, n) > 0);
  });
  return positive;
}

}  // namespace octafront
