#include "base/geometry/big_float.h"

#include <cfloat>
#include <cmath>
#include <cstdint>
#include <random>

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

/// Bits that a machine of any kind has to find: once to 64 bits, then to those of a double.
TEST(BigFloat, QuotientsAreTheSameOnEveryMachine) {
  EXPECT_EQ(quotient(BigFloat(1.0), BigFloat(3.0)), 0x1.5555555555555p-2);
  EXPECT_EQ(quotient(BigFloat(2.0), BigFloat(3.0)), 0x1.5555555555555p-1);
  // The nearest 64 bits of it end in the middle between two doubles: ties to even, though the exact value lies above.
  EXPECT_EQ(quotient(BigFloat(1.0) + BigFloat(0x1p-53) + BigFloat(0x1p-90), BigFloat(1.0)), 1.0);
#if LDBL_MANT_DIG == 64
  std::mt19937_64 random(1);
  for (int i = 0; i < 20000; ++i) {
    const std::uint64_t n = random() | std::uint64_t{1} << 63, d = random() | std::uint64_t{1} << 63;
    const auto whole = [](std::uint64_t x) {
      return BigFloat(static_cast<double>(x >> 32)) * BigFloat(0x1p32) + BigFloat(static_cast<double>(x & 0xffffffffU));
    };
    EXPECT_EQ(quotient(whole(n), whole(d)),
              static_cast<double>(static_cast<long double>(n) / static_cast<long double>(d)));
  }
#endif
}

}  // namespace
}  // namespace octafront::exact
