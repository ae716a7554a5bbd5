#include "base/geometry/curved_tet.h"

#include "base/core/random.h"
#include "base/geometry/quadratic_tet.h"
#include "base/geometry/tet_lattice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using Map = std::function<Vec3(Vec3)>;

const std::array<Vec3, 4> kUnitCorners{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};

Vec3 place_of_node(int order, std::size_t node) {
  const TetLattice::Weights& w = tet_lattice(order).weights(node);
  return Vec3{1.0 * w[1], 1.0 * w[2], 1.0 * w[3]} / order;
}

/// The nodes of the unit tetrahedron where this map has them.
std::vector<Vec3> nodes_by(int order, const Map& map) {
  std::vector<Vec3> nodes;
  for (std::size_t n = 0; n < tet_lattice(order).size(); ++n) nodes.push_back(map(place_of_node(order, n)));
  return nodes;
}

/// A polynomial in the Bernstein basis at a place.
double value(int degree, const std::vector<double>& coefficients, Vec3 at) {
  const std::array<double, 4> l{1 - at.x - at.y - at.z, at.x, at.y, at.z};
  double sum = 0;
  for (std::size_t k = 0; k < coefficients.size(); ++k) {
    const TetLattice::Weights& w = tet_lattice(degree).weights(k);
    double term = std::tgamma(degree + 1);
    for (std::size_t i = 0; i < 4; ++i) term *= std::pow(l[i], w[i]) / std::tgamma(w[i] + 1);
    sum += coefficients[k] * term;
  }
  return sum;
}

TEST(TetLattice, HasEachPlaceOnce) {
  for (int order = 1; order <= kMostOrder; ++order) {
    const TetLattice& lattice = tet_lattice(order);
    EXPECT_EQ(lattice.size(), nodes_of_tet(order));
    std::set<TetLattice::Weights> all;
    for (std::size_t n = 0; n < lattice.size(); ++n) {
      const TetLattice::Weights& w = lattice.weights(n);
      EXPECT_EQ(w[0] + w[1] + w[2] + w[3], order);
      EXPECT_EQ(lattice.at(w), n);
      all.insert(w);
    }
    EXPECT_EQ(all.size(), lattice.size());
  }
}

TEST(CurvedTet, HasTheJacobianOfItsMap) {
  // Of degree 2 in each coordinate's own way, so that the nodes of every order have it exactly but for rounding.
  const Map map = [](Vec3 p) {
    return Vec3{p.x + 0.2 * p.y * p.y - 0.1 * p.x * p.z, p.y + 0.15 * p.x * p.z, p.z - 0.1 * p.x * p.x + 0.05 * p.y};
  };
  const auto jacobian = [](Vec3 p) {
    const Vec3 x{1 - 0.1 * p.z, 0.15 * p.z, -0.2 * p.x}, y{0.4 * p.y, 1, 0.05}, z{-0.1 * p.x, 0.15 * p.x, 1};
    return dot(x, cross(y, z));
  };
  for (int order = 2; order <= kMostOrder; ++order) {
    const std::vector<double> coefficients = jacobian_coefficients(order, nodes_by(order, map));
    for (const Vec3 at : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0.2, 0.3, 0.1}, Vec3{0.1, 0.1, 0.7}, Vec3{0, 0.5, 0.5}})
      EXPECT_NEAR(value(3 * (order - 1), coefficients, at), jacobian(at), 1e-13) << order;
  }
}

TEST(CurvedTet, PlacesAreThoseOfTheMap) {
  const Map map = [](Vec3 p) { return Vec3{p.x + 0.2 * p.y * p.y, p.y - 0.3 * p.x * p.z, p.z + 0.1 * p.x * p.x}; };
  for (int order = 2; order <= kMostOrder; ++order) {
    const std::vector<Vec3> nodes = nodes_by(order, map);
    const double p = order;
    EXPECT_LT(distance(place_in_tet(order, nodes, {0.4 * p, 0.3 * p, 0.2 * p, 0.1 * p}), map({0.3, 0.2, 0.1})), 1e-14);
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      const TetLattice::Weights& w = tet_lattice(order).weights(n);
      EXPECT_EQ(place_in_tet(order, nodes, {1.0 * w[0], 1.0 * w[1], 1.0 * w[2], 1.0 * w[3]}), nodes[n]);
    }
  }
}

TEST(CurvedTet, IsThatOfSecondOrder) {
  Random random(7);
  for (int i = 0; i < 100; ++i) {
    QuadraticTet nodes;
    for (std::size_t n = 0; n < 10; ++n)
      nodes[n] = place_of_node(2, n) + 0.3 * Vec3{random.unit() - 0.5, random.unit() - 0.5, random.unit() - 0.5};
    std::vector<double> ours = jacobian_coefficients(2, nodes);
    const auto theirs = jacobian_coefficients(nodes);
    std::vector<double> sorted(theirs.begin(), theirs.end());
    std::ranges::sort(ours), std::ranges::sort(sorted);
    for (std::size_t k = 0; k < ours.size(); ++k) EXPECT_NEAR(ours[k], sorted[k], 1e-13);
    if (has_positive_jacobian(nodes)) {
      EXPECT_EQ(validity_of(2, nodes), Validity::kValid);
    }
  }
}

TEST(CurvedTet, StraightEdgesHaveOneCoefficient) {
  const std::array<Vec3, 4> corners{Vec3{1, 2, 3}, Vec3{4, 2, 3.5}, Vec3{1.5, 6, 3}, Vec3{2, 2, 8}};
  const auto straight = [&](Vec3 p) {
    return corners[0] + p.x * (corners[1] - corners[0]) + p.y * (corners[2] - corners[0]) +
           p.z * (corners[3] - corners[0]);
  };
  for (int order = 3; order <= kMostOrder; ++order) {
    const std::vector<Vec3> nodes = nodes_by(order, straight);
    const JacobianRange range = jacobian_range(order, nodes);
    EXPECT_NEAR(range.least, range.straight, 1e-11);
    EXPECT_NEAR(range.most, range.straight, 1e-11);
    EXPECT_NEAR(range.volume, range.straight / 6, 1e-12);
    EXPECT_GT(least_scaled_jacobian_bound(order, nodes), 1 - 1e-11);
    EXPECT_EQ(validity_of(order, nodes), Validity::kValid);
  }
}

/// (x - a)^2 - e is the Jacobian: of order 3 and more.
Map with_dip(double e) {
  return [=](Vec3 p) {
    constexpr double kAt = 0.2;
    const double d = p.x - kAt;
    return Vec3{d * d * d / 3 - e * p.x, p.y, p.z};
  };
}

TEST(CurvedTet, ADipInsideIsFound) {
  for (int order = 3; order <= kMostOrder; ++order) {
    EXPECT_EQ(validity_of(order, nodes_by(order, with_dip(1e-3))), Validity::kInvalid) << order;
    // Its coefficients are not all positive: halves tell.
    const std::vector<Vec3> shallow = nodes_by(order, with_dip(-4e-3));
    EXPECT_LT(jacobian_range(order, shallow).least, 0);
    EXPECT_EQ(validity_of(order, shallow), Validity::kValid) << order;
    EXPECT_NE(validity_of(order, nodes_by(order, with_dip(0))), Validity::kValid) << order;
  }
}

TEST(CurvedTet, InsideOutIsInvalid) {
  for (int order = 2; order <= kMostOrder; ++order) {
    EXPECT_EQ(validity_of(order, nodes_by(order, [](Vec3 p) { return Vec3{p.y, p.x, p.z}; })), Validity::kInvalid);
    EXPECT_NE(validity_of(order, nodes_by(order, [](Vec3 p) { return Vec3{p.x, p.y, 0}; })), Validity::kValid);
  }
}

TEST(CurvedTet, TheBoundIsOne) {
  Random random(3);
  for (int order = 3; order <= kMostOrder; ++order)
    for (int i = 0; i < 200; ++i) {
      const double by = 0.2 * random.unit();
      const std::vector<Vec3> nodes = nodes_by(order, [&](Vec3 p) {
        return p + by * Vec3{random.unit() - 0.5, random.unit() - 0.5, random.unit() - 0.5};
      });
      const JacobianRange range = jacobian_range(order, nodes);
      EXPECT_LE(least_scaled_jacobian_bound(order, nodes), range.least / range.straight + 1e-12);
      if (validity_of(order, nodes) != Validity::kValid) continue;
      for (int k = 0; k < 20; ++k) {
        const Vec3 at{random.unit() / 3, random.unit() / 3, random.unit() / 3};
        EXPECT_GT(value(3 * (order - 1), jacobian_coefficients(order, nodes), at), 0);
      }
    }
}

}  // namespace
}  // namespace octafront
