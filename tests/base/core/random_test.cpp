#include "base/core/random.h"

#include <array>

#include <gtest/gtest.h>

namespace octafront {
namespace {

TEST(Random, IsTheSameEverywhere) {
  Random random(1);
  EXPECT_EQ(random.below(1000), 774u);
  EXPECT_EQ(mixed_bits(1), 0x910a2dec89025cc1u);  // SplitMix64 of seed 1, as published
}

TEST(Random, IsEvenlySpread) {
  Random random(7);
  std::array<int, 10> dice{}, tenths{};
  for (int i = 0; i < 100000; ++i) {
    ++dice[random.below(10)];
    const double u = random.unit();
    ASSERT_GE(u, 0);
    ASSERT_LT(u, 1);
    ++tenths[static_cast<std::size_t>(10 * u)];
  }
  // Six standard deviations.
  for (const int n : dice) EXPECT_NEAR(n, 10000, 570);
  for (const int n : tenths) EXPECT_NEAR(n, 10000, 570);
}

}  // namespace
}  // namespace octafront
