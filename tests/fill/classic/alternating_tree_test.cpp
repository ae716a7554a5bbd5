#include "fill/classic/alternating_tree.h"

#include <algorithm>
#include <map>
#include <random>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using Key = std::array<double, 3>;

// Against a plain list, under insertions and removals, with points on cell borders, equal points and points outside.
TEST(AlternatingTree, FindsWhatALinearSearchFinds) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> grid(-2, 10);
  const auto coordinate = [&] { return grid(random) / 8.0; };
  AlternatingTree<3> tree({0, 0, 0}, {1, 1, 1});
  std::map<std::uint32_t, Key> listed;
  for (std::uint32_t step = 0; step < 4000; ++step) {
    if (listed.size() > 300 || (step % 3 == 2 && !listed.empty())) {
      const auto victim = std::next(listed.begin(), static_cast<long>(random() % listed.size()));
      tree.remove(victim->first);
      listed.erase(victim);
    } else {
      listed[step] = {coordinate(), coordinate(), coordinate()};
      tree.insert(step, listed[step]);
    }
    Key from{coordinate(), coordinate(), coordinate()}, to{coordinate(), coordinate(), coordinate()};
    for (int k = 0; k < 3; ++k)
      if (from[k] > to[k]) std::swap(from[k], to[k]);
    std::vector<std::uint32_t> found, expected;
    tree.find({from, to}, [&](std::uint32_t i) { found.push_back(i); });
    for (const auto& [i, key] : listed) {
      bool in = true;
      for (int k = 0; k < 3; ++k) in = in && from[k] <= key[k] && key[k] <= to[k];
      if (in) expected.push_back(i);
    }
    std::sort(found.begin(), found.end());
    ASSERT_EQ(found, expected) << "step " << step;
    if (step % 500 == 0) {
      EXPECT_EQ(tree.first_inconsistency(), std::nullopt);
    }
  }
  EXPECT_EQ(tree.size(), listed.size());
}

/// Breaks the contract: an item is in the tree once.
TEST(AlternatingTree, SaysWhichItemItWouldNotFind) {
  AlternatingTree<3> tree({0, 0, 0}, {1, 1, 1});
  tree.insert(4, {0.2, 0.2, 0.2});
  tree.insert(7, {0.7, 0.2, 0.2});
  EXPECT_EQ(tree.first_inconsistency(), std::nullopt);
  EXPECT_EQ(tree.first_inconsistency(5), "item 5 is not in the tree");
  tree.insert(7, {0.1, 0.9, 0.2});
  EXPECT_EQ(tree.first_inconsistency(), "item 7 is not where the tree looks for it");
}

}  // namespace
}  // namespace octafront
