#include "base/core/disjoint_sets.h"

#include "support/random.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace octafront {
namespace {

TEST(DisjointSets, AreSinglesAtFirst) {
  DisjointSets sets(4);
  for (std::uint32_t i = 0; i < 4; ++i) EXPECT_EQ(sets.find(i), i);
}

TEST(DisjointSets, AreNamedByTheirLeastMemberWhateverTheOrderOfTheJoins) {
  constexpr int n = 200;
  testing::Random random(1);
  DisjointSets sets(n);
  std::vector<std::uint32_t> least(n);  // by brute force
  for (std::uint32_t i = 0; i < n; ++i) least[i] = i;
  for (int step = 0; step < 150; ++step) {
    const auto i = static_cast<std::uint32_t>(random.integer(0, n - 1));
    const auto j = static_cast<std::uint32_t>(random.integer(0, n - 1));
    sets.join(i, j);
    const auto [low, high] = std::minmax({least[i], least[j]});
    for (std::uint32_t& l : least)
      if (l == high) l = low;
  }
  for (std::uint32_t i = 0; i < n; ++i) EXPECT_EQ(sets.find(i), least[i]);
}

}  // namespace
}  // namespace octafront
