// The same bits everywhere, and as near to the truth as two or three units in the last place: against long double.

#include "base/core/elementary.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace octafront {
namespace {

class Elementary : public ::testing::Test {
 protected:
  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

  static void expect_near(double made, long double truth, double ulps) {
    const auto nearest = static_cast<double>(truth);
    const double unit = std::nextafter(std::abs(nearest), HUGE_VAL) - std::abs(nearest);
    EXPECT_LE(std::abs(static_cast<double>(made - truth)), ulps * unit) << made << " for " << nearest;
  }

  std::mt19937_64 random_{1};
};

constexpr int kTries = 20'000;

TEST_F(Elementary, PowersAndLogarithms) {
  for (int i = 0; i < kTries; ++i) {
    const double x = between(-700, 700), positive = elementary::exp(x);
    expect_near(positive, std::exp(static_cast<long double>(x)), 2);
    expect_near(elementary::log(positive), std::log(static_cast<long double>(positive)), 2);
    expect_near(elementary::log2(positive), std::log2(static_cast<long double>(positive)), 2);
    expect_near(elementary::exp2(x), std::exp2(static_cast<long double>(x)), 2);
    expect_near(elementary::cbrt(positive), std::cbrt(static_cast<long double>(positive)), 4);
  }
  for (int k = -1000; k < 1000; ++k) {
    EXPECT_EQ(elementary::exp2(k), std::ldexp(1.0, k));
    EXPECT_EQ(elementary::log2(std::ldexp(1.0, k)), k);
  }
}

TEST_F(Elementary, Angles) {
  for (int i = 0; i < kTries; ++i) {
    const double x = between(-1, 1), y = between(-1, 1), far = between(-1e4, 1e4);
    expect_near(elementary::atan2(y, x), std::atan2(static_cast<long double>(y), static_cast<long double>(x)), 4);
    expect_near(elementary::acos(x), std::acos(static_cast<long double>(x)), 5);
    expect_near(elementary::hypot(x, y), std::hypot(static_cast<long double>(x), static_cast<long double>(y)), 2);
    EXPECT_NEAR(elementary::sin(far), std::sin(far), 1e-15);
    EXPECT_NEAR(elementary::cos(far), std::cos(far), 1e-15);
    EXPECT_NEAR(elementary::tan(x), std::tan(x), 1e-15);
  }
}

TEST_F(Elementary, EndsAndExceptions) {
  EXPECT_EQ(elementary::exp(-HUGE_VAL), 0);
  EXPECT_EQ(elementary::exp(800), HUGE_VAL);
  EXPECT_EQ(elementary::log(0), -HUGE_VAL);
  EXPECT_EQ(elementary::log(HUGE_VAL), HUGE_VAL);
  EXPECT_TRUE(std::isnan(elementary::log(-1)));
  EXPECT_TRUE(std::isnan(elementary::exp(std::nan(""))));
  EXPECT_EQ(elementary::atan2(0, 0), 0);
  EXPECT_EQ(elementary::atan2(0, -1), std::numbers::pi);
  EXPECT_EQ(elementary::acos(1), 0);
  EXPECT_EQ(elementary::cbrt(0), 0);
  EXPECT_EQ(elementary::pow(0, 3), 0);
  EXPECT_EQ(elementary::pow(-2, 3), -8);
  EXPECT_EQ(elementary::pow(2, -2), 0.25);
  EXPECT_NEAR(elementary::pow(128, 1.0 / 7), 2, 1e-15);
  EXPECT_EQ(elementary::sin(0), 0);
  EXPECT_EQ(elementary::cos(0), 1);
}

}  // namespace
}  // namespace octafront
