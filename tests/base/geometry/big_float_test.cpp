#include "base/geometry/big_float.h"

#include <cmath>

#include <gtest/gtest.h>

namespace octafront::exact {
namespace {

TEST(BigFloat, AddsWithoutRounding) {
  const BigFloat big(0x1p200), small(0x1.8p-300);
  EXPECT_EQ((big + small - big - small).sign(), 0);
  EXPECT_EQ((big + small - big).sign(), 1);
  EXPECT_EQ((big - small - big).sign(), -1);
}

TEST(BigFloat, MultipliesWithoutRounding) {
  const BigFloat a(1 + 0x1p-52), b(1 - 0x1p-52), one(1.0), square(0x1p-104);
  EXPECT_EQ((a * b - one + square).sign(), 0);
}

TEST(BigFloat, CarriesThroughManyLimbs) {
  BigFloat power(1.0), sum(0.0);
  const BigFloat third(3.0);
  for (int i = 0; i < 700; ++i) {
    sum = sum + power + power;
    power = power * third;
  }
  // 2 (1 + 3 + ... + 3^699) = 3^700 - 1
  EXPECT_EQ((sum + BigFloat(1.0) - power).sign(), 0);
}

TEST(BigFloat, DividesToDoublePrecision) {
  EXPECT_NEAR(quotient(BigFloat(1.0), BigFloat(-3.0)), -1.0 / 3, 1e-15);
  EXPECT_EQ(quotient(BigFloat(0.0), BigFloat(7.0)), 0);
  EXPECT_EQ(quotient(BigFloat(0x1p-600) * BigFloat(0x1p-600), BigFloat(0x1p-600) * BigFloat(0x1p-500)), 0x1p-100);
}

}  // namespace
}  // namespace octafront::exact
