#include "base/geometry/curved_tet.h"

#include "base/geometry/big_float.h"
#include "base/geometry/predicates.h"
#include "base/geometry/tet_lattice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

namespace octafront {

namespace {

using Weights = TetLattice::Weights;

std::int64_t factorial(int n) {
  return n < 2 ? 1 : n * factorial(n - 1);
}

std::int64_t factorials(const Weights& w) {
  return factorial(w[0]) * factorial(w[1]) * factorial(w[2]) * factorial(w[3]);
}

Weights sum(Weights a, const Weights& b) {
  for (std::size_t i = 0; i < 4; ++i) a[i] = static_cast<std::int8_t>(a[i] + b[i]);
  return a;
}

Weights unit(std::size_t i) {
  Weights w{};
  w[i] = 1;
  return w;
}

/// A homogeneous polynomial in barycentric coordinates, with whole coefficients by the nodes of tet_lattice(degree).
struct Polynomial {
  int degree = 0;
  std::vector<std::int64_t> of{1};

  /// Times (a l_i - b), where 1 is the sum of all coordinates.
  Polynomial times(std::size_t i, std::int64_t a, std::int64_t b) const {
    const TetLattice &from = tet_lattice(degree), &to = tet_lattice(degree + 1);
    Polynomial product{degree + 1, std::vector<std::int64_t>(to.size(), 0)};
    for (std::size_t n = 0; n < from.size(); ++n)
      for (std::size_t k = 0; k < 4; ++k)
        product.of[to.at(sum(from.weights(n), unit(k)))] += of[n] * ((k == i ? a : 0) - b);
    return product;
  }
};

/// A node and how it counts.
struct Share {
  std::size_t node;
  double whole;  ///< over Tables::denominator
};

/// All that depends on the order alone.
struct Tables {
  explicit Tables(int p);

  int order;
  const TetLattice &nodes, &entries, &pairs, &coefficients;  ///< of degree p, p - 1, 2 (p - 1), 3 (p - 1)
  double denominator = 1;
  /// By direction (of corner 1, 2, 3 from corner 0) and entry: a control point of that column of the Jacobian.
  std::array<std::vector<std::vector<Share>>, 3> columns;
  /// An entry counts by this in products; a product by the inverse of that of its own degree.
  std::vector<double> of_entry, of_coefficient;
  /// Which pair two entries are of, and which coefficient an entry and a pair: a row for each entry.
  std::vector<std::uint16_t> pair_of, coefficient_of;
  double most_off = 0;  ///< a column is off by so much of the longest way of a node at most
};

/// The coefficients, in the Bernstein basis, of the polynomials that are 1 at one node and 0 at others, times
/// (p!)^2: [coefficient][node].
std::vector<std::vector<std::int64_t>> control_of_nodes(int p) {
  const TetLattice& lattice = tet_lattice(p);
  std::vector<std::vector<std::int64_t>> all(lattice.size(), std::vector<std::int64_t>(lattice.size()));
  for (std::size_t n = 0; n < lattice.size(); ++n) {
    Polynomial one;
    for (std::size_t i = 0; i < 4; ++i)
      for (int m = 0; m < lattice.weights(n)[i]; ++m) one = one.times(i, p, m);
    const std::int64_t scale = factorial(p) / factorials(lattice.weights(n));
    for (std::size_t c = 0; c < lattice.size(); ++c) all[c][n] = one.of[c] * factorials(lattice.weights(c)) * scale;
  }
  return all;
}

Tables::Tables(int p)
    : order(p),
      nodes(tet_lattice(p)),
      entries(tet_lattice(p - 1)),
      pairs(tet_lattice(2 * (p - 1))),
      coefficients(tet_lattice(3 * (p - 1))) {
  const auto control = control_of_nodes(p);
  denominator = static_cast<double>(factorial(p) * factorial(p));
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t e = 0; e < entries.size(); ++e) {
      std::vector<Share>& shares = columns[c].emplace_back();
      const auto& towards = control[nodes.at(sum(entries.weights(e), unit(c + 1)))];
      const auto& from = control[nodes.at(sum(entries.weights(e), unit(0)))];
      double all = 0;
      for (std::size_t n = 0; n < nodes.size(); ++n)
        if (const std::int64_t whole = p * (towards[n] - from[n]); whole != 0) {
          shares.push_back({n, static_cast<double>(whole)});
          all += std::abs(static_cast<double>(whole));
        }
      most_off = std::max(most_off, all / denominator);
    }
  for (std::size_t e = 0; e < entries.size(); ++e)
    of_entry.push_back(static_cast<double>(factorial(p - 1) / factorials(entries.weights(e))));
  for (std::size_t i = 0; i < entries.size(); ++i) {
    for (std::size_t j = 0; j < entries.size(); ++j)
      pair_of.push_back(static_cast<std::uint16_t>(pairs.at(sum(entries.weights(i), entries.weights(j)))));
    for (std::size_t j = 0; j < pairs.size(); ++j)
      coefficient_of.push_back(static_cast<std::uint16_t>(coefficients.at(sum(entries.weights(i), pairs.weights(j)))));
  }
  for (std::size_t k = 0; k < coefficients.size(); ++k)
    of_coefficient.push_back(static_cast<double>(factorials(coefficients.weights(k))) /
                             static_cast<double>(factorial(3 * (p - 1))));
}

const Tables& tables_of(int order) {
  static const std::array<Tables, 3> kAll{Tables(2), Tables(3), Tables(4)};
  return kAll[static_cast<std::size_t>(order - 2)];
}

/// Columns at the control points.
using Columns = std::array<std::vector<Vec3>, 3>;

Columns columns_of(const Tables& tables, std::span<const Vec3> x) {
  Columns g;
  for (std::size_t c = 0; c < 3; ++c)
    for (const std::vector<Share>& shares : tables.columns[c]) {
      Vec3 sum;
      for (const auto& [node, whole] : shares) sum += whole * (x[node] - x[0]);
      g[c].push_back(sum / tables.denominator);
    }
  return g;
}

std::vector<double> coefficients_of(const Tables& t, const Columns& g) {
  std::vector<Vec3> pairs(t.pairs.size());
  for (std::size_t i = 0; i < t.entries.size(); ++i)
    for (std::size_t j = 0; j < t.entries.size(); ++j)
      pairs[t.pair_of[i * t.entries.size() + j]] += t.of_entry[i] * t.of_entry[j] * cross(g[1][i], g[2][j]);
  std::vector<double> all(t.coefficients.size());
  for (std::size_t i = 0; i < t.entries.size(); ++i)
    for (std::size_t j = 0; j < t.pairs.size(); ++j)
      all[t.coefficient_of[i * t.pairs.size() + j]] += t.of_entry[i] * dot(g[0][i], pairs[j]);
  for (std::size_t k = 0; k < all.size(); ++k) all[k] *= t.of_coefficient[k];
  return all;
}

/// How much a coefficient may be off. Each is a mean of determinants, none of which is more than the product of the
/// longest columns (Hadamard); with eps = 2^-53 an entry errs by 37 eps of its magnitudes at most, a product of three
/// by three times that and 8, 42 additions follow, and nine for each time that the element is halved.
double rounding_of(const Tables& tables, std::span<const Vec3> x) {
  constexpr double kRounding = 1000 * 0x1p-53;
  double most = 1;
  for (const auto& column : tables.columns) {
    double longest = 0;
    for (const std::vector<Share>& shares : column) {
      double sum = 0;
      for (const auto& [node, whole] : shares) sum += std::abs(whole) * length(x[node] - x[0]);
      longest = std::max(longest, sum / tables.denominator);
    }
    most *= longest;
  }
  return kRounding * most;
}

using Exact = exact::BigFloat;
using ExactVec = std::array<Exact, 3>;

Exact exact_determinant(const ExactVec& a, const ExactVec& b, const ExactVec& c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
}

/// Columns times the denominator.
std::array<std::vector<ExactVec>, 3> exact_columns(const Tables& tables, std::span<const Vec3> x) {
  std::array<std::vector<ExactVec>, 3> g;
  for (std::size_t c = 0; c < 3; ++c)
    for (const std::vector<Share>& shares : tables.columns[c]) {
      ExactVec& entry = g[c].emplace_back();
      for (const auto& [node, whole] : shares)
        for (std::size_t axis = 0; axis < 3; ++axis)
          entry[axis] = entry[axis] + Exact(whole) * Exact(x[node][static_cast<int>(axis)]);
    }
  return g;
}

/// The sign of one coefficient.
int exact_sign_of_coefficient(const Tables& t, const std::array<std::vector<ExactVec>, 3>& g, std::size_t coefficient) {
  Exact all;
  for (std::size_t i = 0; i < t.entries.size(); ++i)
    for (std::size_t j = 0; j < t.entries.size(); ++j)
      for (std::size_t k = 0; k < t.entries.size(); ++k) {
        const Weights w = sum(sum(t.entries.weights(i), t.entries.weights(j)), t.entries.weights(k));
        if (w != t.coefficients.weights(coefficient)) continue;
        all = all + Exact(t.of_entry[i] * t.of_entry[j] * t.of_entry[k]) * exact_determinant(g[0][i], g[1][j], g[2][k]);
      }
  return all.sign();
}

/// A part of an element: its Jacobian there, and where its corners are.
struct PartOfTet {
  std::vector<double> coefficients;
  std::array<std::array<double, 4>, 4> corners;
};

double least_coefficient(const PartOfTet& part) {
  return *std::ranges::min_element(part.coefficients);
}

PartOfTet whole_tet(std::vector<double> coefficients) {
  return {std::move(coefficients), {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}}};
}

/// The two corners of a part that are farthest from each other.
std::pair<std::size_t, std::size_t> longest_edge_of_part(const PartOfTet& part) {
  std::pair<std::size_t, std::size_t> longest{0, 1};
  double most = -1;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j) {
      double squared = 0;
      for (std::size_t k = 0; k < 4; ++k)
        squared += (part.corners[i][k] - part.corners[j][k]) * (part.corners[i][k] - part.corners[j][k]);
      if (squared > most) most = squared, longest = {i, j};
    }
  return longest;
}

/// The part with corner `moved` in the middle of its edge to `kept` (de Casteljau's algorithm along it).
PartOfTet half_of(const TetLattice& lattice, const PartOfTet& part, std::size_t kept, std::size_t moved) {
  PartOfTet half = part;
  for (std::size_t k = 0; k < 4; ++k) half.corners[moved][k] = 0.5 * (part.corners[kept][k] + part.corners[moved][k]);
  // Coefficients along each line of the lattice from `kept` to `moved`, by themselves.
  for (std::size_t n = 0; n < lattice.size(); ++n) {
    Weights w = lattice.weights(n);
    if (w[moved] != 0) continue;
    const int length = w[kept];
    std::array<std::size_t, 10> line{};
    for (int i = 0; i <= length; ++i) {
      line[static_cast<std::size_t>(i)] = lattice.at(w);
      --w[kept], ++w[moved];
    }
    for (int level = 1; level <= length; ++level)
      for (int i = length; i >= level; --i) {
        double& at = half.coefficients[line[static_cast<std::size_t>(i)]];
        at = 0.5 * (at + half.coefficients[line[static_cast<std::size_t>(i - 1)]]);
      }
  }
  return half;
}

/// By halves of the element where some coefficient is not positive.
Validity validity_by_halves(const TetLattice& lattice, std::vector<double> coefficients, double off) {
  constexpr std::size_t kMostParts = 4096;
  std::vector<PartOfTet> left;
  left.push_back(whole_tet(std::move(coefficients)));
  for (std::size_t looked = 0; !left.empty(); ++looked) {
    if (looked == kMostParts) return Validity::kUndecided;
    const PartOfTet part = std::move(left.back());
    left.pop_back();
    if (least_coefficient(part) > off) continue;
    // The coefficients of corners are values.
    if (*std::min_element(part.coefficients.begin(), part.coefficients.begin() + 4) < -off) return Validity::kInvalid;
    const auto [a, b] = longest_edge_of_part(part);
    left.push_back(half_of(lattice, part, a, b));
    left.push_back(half_of(lattice, part, b, a));
  }
  return Validity::kValid;
}

}  // namespace

Vec3 place_in_tet(int order, std::span<const Vec3> nodes, const std::array<double, 4>& at) {
  const TetLattice& lattice = tet_lattice(order);
  Vec3 sum;
  for (std::size_t n = 0; n < lattice.size(); ++n) {
    double share = 1;
    for (std::size_t i = 0; i < 4; ++i)
      for (int m = 0; m < lattice.weights(n)[i]; ++m) share *= (at[i] - m) / (lattice.weights(n)[i] - m);
    if (share != 0) sum += share * nodes[n];
  }
  return sum;
}

double least_jacobian(int order, std::span<const Vec3> nodes, std::size_t parts) {
  const TetLattice& lattice = tables_of(order).coefficients;
  const auto is_better = [](const PartOfTet& a, const PartOfTet& b) {
    return least_coefficient(a) > least_coefficient(b);
  };
  std::vector<PartOfTet> all{whole_tet(jacobian_coefficients(order, nodes))};
  while (all.size() < parts) {
    std::ranges::pop_heap(all, is_better);
    const PartOfTet worst = std::move(all.back());
    all.pop_back();
    // The coefficients of corners are values: no half is worse than these.
    if (*std::min_element(worst.coefficients.begin(), worst.coefficients.begin() + 4) <= least_coefficient(worst))
      return least_coefficient(worst);
    const auto [a, b] = longest_edge_of_part(worst);
    for (const auto& [kept, moved] : {std::pair{a, b}, std::pair{b, a}}) {
      all.push_back(half_of(lattice, worst, kept, moved));
      std::ranges::push_heap(all, is_better);
    }
  }
  return least_coefficient(all.front());
}

std::vector<double> jacobian_coefficients(int order, std::span<const Vec3> nodes) {
  const Tables& tables = tables_of(order);
  return coefficients_of(tables, columns_of(tables, nodes));
}

JacobianRange jacobian_range(int order, std::span<const Vec3> nodes) {
  const std::vector<double> all = jacobian_coefficients(order, nodes);
  const auto [least, most] = std::ranges::minmax_element(all);
  // The integral of a polynomial over the unit tetrahedron is the mean of its coefficients over six.
  const double volume = std::accumulate(all.begin(), all.end(), 0.0) / (6.0 * static_cast<double>(all.size()));
  return {dot(nodes[1] - nodes[0], cross(nodes[2] - nodes[0], nodes[3] - nodes[0])), *least, *most, volume};
}

double least_scaled_jacobian_bound(int order, std::span<const Vec3> x) {
  const Tables& tables = tables_of(order);
  double squared = 0;
  for (std::size_t n = 4; n < tables.nodes.size(); ++n) {
    Vec3 straight;
    for (std::size_t i = 1; i < 4; ++i) straight += tables.nodes.weights(n)[i] * (x[i] - x[0]);
    squared = std::max(squared, squared_length(x[n] - x[0] - straight / order));
  }
  const double lu = length(x[1] - x[0]), lv = length(x[2] - x[0]), lw = length(x[3] - x[0]);
  const double straight = dot(x[1] - x[0], cross(x[2] - x[0], x[3] - x[0]));
  // A dozen roundings of terms below an edge each.
  constexpr double kRoundingOfNodes = 16 * 0x1p-53, kRounding = 64 * 0x1p-53;
  const double off = tables.most_off * (std::sqrt(squared) + kRoundingOfNodes * (lu + lv + lw));
  const double most = (lu + off) * (lv + off) * (lw + off), change = most - lu * lv * lw + kRounding * most;
  return straight > 0 ? 1 - change / straight : -std::numeric_limits<double>::infinity();
}

Validity validity_of(int order, std::span<const Vec3> nodes) {
  constexpr double kSure = 64 * 0x1p-53;
  if (least_scaled_jacobian_bound(order, nodes) > kSure) return Validity::kValid;
  const Tables& tables = tables_of(order);
  const double off = rounding_of(tables, nodes);
  std::vector<double> all = coefficients_of(tables, columns_of(tables, nodes));
  const double least = *std::ranges::min_element(all);
  if (least > off) return Validity::kValid;
  if (least < -off) return validity_by_halves(tables.coefficients, std::move(all), off);
  const auto columns = exact_columns(tables, nodes);
  for (std::size_t k = 0; k < all.size(); ++k)
    if (all[k] <= off && exact_sign_of_coefficient(tables, columns, k) <= 0)
      return k < 4 ? Validity::kInvalid : validity_by_halves(tables.coefficients, std::move(all), off);
  return Validity::kValid;
}

}  // namespace octafront
