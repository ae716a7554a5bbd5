#include "base/geometry/quadratic_tet.h"

#include "base/geometry/big_integer.h"
#include "base/geometry/measures.h"
#include "support/random.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using testing::BigInteger;

constexpr int kFractionOfBends = 300;
constexpr std::array<std::array<int, 2>, 6> kEdges{{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

QuadraticTet straight(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  QuadraticTet q{a, b, c, d};
  for (std::size_t e = 0; e < 6; ++e)
    q[4 + e] = 0.5 * (q[static_cast<std::size_t>(kEdges[e][0])] + q[static_cast<std::size_t>(kEdges[e][1])]);
  return q;
}

QuadraticTet unit() {
  return straight({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
}

// --- the oracle: derivatives of the shape functions at the corners, all in integers of any length

BigInteger big(double x) {
  return BigInteger(x, kFractionOfBends);
}

/// 4 N derivative weights: d/d lambda_c of the interpolation at corner i, minus that by lambda_0.
std::array<std::array<BigInteger, 3>, 3> columns_at(const QuadraticTet& q, int i) {
  std::array<std::array<BigInteger, 3>, 3> columns;
  for (int c = 1; c < 4; ++c)
    for (int axis = 0; axis < 3; ++axis) {
      const auto slope = [&](int k) {
        // Of lambda_k (2 lambda_k - 1): 4 lambda_k - 1; of 4 lambda_k lambda_j: 4 lambda_j.
        BigInteger sum = BigInteger(i == k ? 3 : -1) * big(q[static_cast<std::size_t>(k)][axis]);
        for (std::size_t e = 0; e < 6; ++e)
          if (const auto& [a, b] = kEdges[e]; (a == k && b == i) || (b == k && a == i))
            sum = sum + BigInteger(4) * big(q[4 + e][axis]);
        return sum;
      };
      columns[static_cast<std::size_t>(c - 1)][static_cast<std::size_t>(axis)] = slope(c) - slope(0);
    }
  return columns;
}

int oracle_sign(const QuadraticTet& q, std::array<int, 3> corners) {
  std::array<std::array<std::array<BigInteger, 3>, 3>, 4> g;
  for (int i = 0; i < 4; ++i) g[static_cast<std::size_t>(i)] = columns_at(q, i);
  std::array<int, 3> order{0, 1, 2};
  BigInteger sum;
  do {
    const auto& a = g[static_cast<std::size_t>(corners[static_cast<std::size_t>(order[0])])][0];
    const auto& b = g[static_cast<std::size_t>(corners[static_cast<std::size_t>(order[1])])][1];
    const auto& c = g[static_cast<std::size_t>(corners[static_cast<std::size_t>(order[2])])][2];
    sum = sum + a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
          a[2] * (b[0] * c[1] - b[1] * c[0]);
  } while (std::next_permutation(order.begin(), order.end()));
  return sum.sign();
}

bool oracle_positive(const QuadraticTet& q) {
  for (int i = 0; i < 4; ++i)
    for (int j = i; j < 4; ++j)
      for (int k = j; k < 4; ++k)
        if (oracle_sign(q, {i, j, k}) <= 0) return false;
  return true;
}

TEST(QuadraticTet, StraightElementsHaveTwentyTimesTheSameCoefficient) {
  const QuadraticTet q = straight({0.1, 0.2, 0.3}, {1.5, 0.1, 0.2}, {0.3, 1.1, 0.4}, {0.2, 0.3, 0.9});
  for (const double c : jacobian_coefficients(q)) EXPECT_NEAR(c, six_volumes(q[0], q[1], q[2], q[3]), 1e-14);
  EXPECT_TRUE(has_positive_jacobian(q));
}

TEST(QuadraticTet, CoefficientsAreThoseOfTheDeterminant) {
  testing::Random random(1);
  for (int round = 0; round < 100; ++round) {
    QuadraticTet q = unit();
    for (Vec3& p : q) p += {random.between(-0.2, 0.2), random.between(-0.2, 0.2), random.between(-0.2, 0.2)};
    const auto coefficients = jacobian_coefficients(q);
    std::array<double, 4> place{random.unit(), random.unit(), random.unit(), random.unit()};
    const double sum = std::accumulate(place.begin(), place.end(), 0.0);
    for (double& p : place) p /= sum;
    double value = 0;
    std::size_t number = 0;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i; j < 4; ++j)
        for (std::size_t k = j; k < 4; ++k) {
          const int orders = i == k ? 1 : i == j || j == k ? 3 : 6;
          value += orders * place[i] * place[j] * place[k] * coefficients[number++];
        }
    EXPECT_NEAR(value, jacobian_determinant(q, place), 1e-13);
  }
}

TEST(QuadraticTet, VolumeIsTheMeanOfTheCoefficients) {
  QuadraticTet q = unit();
  for (const std::size_t mid : {7u, 8u, 9u}) q[mid] = normalized(q[mid]);
  const auto coefficients = jacobian_coefficients(q);
  const double volume = std::accumulate(coefficients.begin(), coefficients.end(), 0.0) / 120;
  // Keast's rule of five points, exact for polynomials of degree three.
  double integral = -4 / 5.0 * jacobian_determinant(q, {0.25, 0.25, 0.25, 0.25});
  for (std::size_t i = 0; i < 4; ++i) {
    std::array<double, 4> place;
    place.fill(1 / 6.0);
    place[i] = 0.5;
    integral += 9 / 20.0 * jacobian_determinant(q, place);
  }
  EXPECT_NEAR(volume, integral / 6, 1e-14);
  EXPECT_GT(volume, 2 * signed_volume(q[0], q[1], q[2], q[3]));
  EXPECT_TRUE(has_positive_jacobian(q));
}

TEST(QuadraticTet, AMidSideNodeNearACornerIsFound) {
  QuadraticTet q = unit();
  q[4] = {0.2, 0, 0};  // before a quarter of the edge the Jacobian at its corner turns
  EXPECT_FALSE(has_positive_jacobian(q));
  q[4] = {0.3, 0, 0};
  EXPECT_TRUE(has_positive_jacobian(q));
}

TEST(QuadraticTet, ExactlyZeroIsNotPositive) {
  QuadraticTet q = unit();
  q[4] = {0.25, 0, 0};
  EXPECT_FALSE(has_positive_jacobian(q));
  q[4].x = std::nextafter(0.25, 1.0);
  EXPECT_TRUE(has_positive_jacobian(q));
  q[4].x = std::nextafter(0.25, 0.0);
  EXPECT_FALSE(has_positive_jacobian(q));
  EXPECT_FALSE(has_positive_jacobian(straight({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0})));
  EXPECT_FALSE(has_positive_jacobian(straight({0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1})));
}

TEST(QuadraticTet, SignsAgreeWithIntegersWhereRoundingIsNotSure) {
  testing::Random random(2);
  int positive = 0, negative = 0;
  for (int round = 0; round < 400; ++round) {
    // Flat to a few units in the last place, or with a node where a coefficient vanishes; near the origin or far.
    const Vec3 far = round % 3 == 0 ? Vec3{1e3, -2e3, 3e3} : Vec3{};
    const double height = random.between(0.2, 1.5);
    QuadraticTet q = straight(far, far + Vec3{1, 0.1, 0}, far + Vec3{0.2, 1, 0}, far + Vec3{0.3, 0.3, height});
    if (round % 2 == 0) {
      q = straight(far, far + Vec3{1, 0.1, 0}, far + Vec3{0.2, 1, 0},
                   far + Vec3{0.3, 0.3, random.between(-4, 8) * 0x1p-52 * (1 + length(far))});
    } else {
      const int edge = random.integer(0, 5);
      const Vec3 a = q[static_cast<std::size_t>(kEdges[static_cast<std::size_t>(edge)][0])],
                 b = q[static_cast<std::size_t>(kEdges[static_cast<std::size_t>(edge)][1])];
      q[static_cast<std::size_t>(4 + edge)] = a + 0.25 * (b - a);
    }
    const bool expected = oracle_positive(q);
    ASSERT_EQ(has_positive_jacobian(q), expected) << round;
    ++(expected ? positive : negative);
  }
  EXPECT_GT(positive, 20);
  EXPECT_GT(negative, 20);
}

TEST(QuadraticTet, TheBoundIsBelowTheLeastCoefficient) {
  testing::Random random(4);
  int sure = 0;
  for (int round = 0; round < 300; ++round) {
    const double bend = random.magnitude(1e-6, 0.1);
    QuadraticTet q = straight({0, 0, 0}, {1, random.between(-0.4, 0.4), 0}, {random.between(-0.4, 0.4), 1, 0},
                              {0.2, 0.3, random.between(0.05, 1)});
    for (std::size_t mid = 4; mid < 10; ++mid)
      q[mid] += {random.between(-bend, bend), random.between(-bend, bend), random.between(-bend, bend)};
    const auto coefficients = jacobian_coefficients(q);
    const double least =
        *std::min_element(coefficients.begin(), coefficients.end()) / six_volumes(q[0], q[1], q[2], q[3]);
    const double bound = least_scaled_jacobian_bound(q);
    ASSERT_LE(bound, least);
    if (bound <= 0) continue;
    ++sure;
    ASSERT_TRUE(oracle_positive(q));
  }
  EXPECT_GT(sure, 100);
  EXPECT_GT(least_scaled_jacobian_bound(unit()), 1 - 1e-13);
  EXPECT_LT(least_scaled_jacobian_bound(straight({0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1})), 0);
}

TEST(QuadraticTet, SignsDoNotDependOnScale) {
  testing::Random random(3);
  for (int round = 0; round < 50; ++round) {
    QuadraticTet q = unit();
    for (std::size_t mid = 4; mid < 10; ++mid)
      q[mid] += {random.between(-0.12, 0.12), random.between(-0.12, 0.12), random.between(-0.12, 0.12)};
    const bool expected = has_positive_jacobian(q);
    for (const double scale : {0x1p-60, 0x1p60}) {
      QuadraticTet scaled = q;
      for (Vec3& p : scaled) p *= scale;
      EXPECT_EQ(has_positive_jacobian(scaled), expected);
    }
  }
}

}  // namespace
}  // namespace octafront
