#include "base/core/disjoint_sets.h"

#include "base/core/parallel.h"
#include "support/random.h"

#include <algorithm>
#include <array>
#include <vector>

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

TEST(DisjointSets, SeveralThreadsJoinTheSameSets) {
  constexpr std::uint32_t kNumbers = 50'000;
  std::vector<std::array<std::uint32_t, 2>> pairs;
  testing::Random random(7);
  for (std::uint32_t k = 0; k < kNumbers; ++k)  // sets of all lengths, some of them chains
    pairs.push_back(k % 3 == 0 ? std::array{k, std::min(k + 1, kNumbers - 1)}
                               : std::array{k, static_cast<std::uint32_t>(random.integer(0, kNumbers - 1))});
  pairs.resize(kNumbers / 2);
  DisjointSets alone(kNumbers), shared(kNumbers);
  for (const auto& [i, j] : pairs) alone.join(i, j);
  parallel_for(pairs.size(), [&](std::size_t p) { shared.join_shared(pairs[p][0], pairs[p][1]); });
  for (std::uint32_t k = 0; k < kNumbers; ++k) EXPECT_EQ(shared.find_shared(k), alone.find(k)) << k;
}

}  // namespace
}  // namespace octafront
