#include "base/core/groups.h"

#include "base/core/thread_limit.h"
#include "support/random.h"

#include <array>
#include <map>
#include <numeric>

#include <gtest/gtest.h>

namespace octafront {
namespace {

template <class Span>
std::vector<std::uint32_t> listed(const Span& s) {
  return {s.begin(), s.end()};
}

TEST(Groups, HoldEveryItemOfAnOwnerInTheOrderOfTheVisits) {
  testing::Random random(1);
  std::vector<std::array<std::uint32_t, 2>> pairs;  // owner, item
  std::map<std::uint32_t, std::vector<std::uint32_t>> expected;
  for (int i = 0; i < 1000; ++i) {
    const auto owner = static_cast<std::uint32_t>(random.integer(0, 39)),
               item = static_cast<std::uint32_t>(random.bits());
    pairs.push_back({owner, item});
    expected[owner].push_back(item);
  }
  const Groups<> groups(40, [&](const auto& add) {
    for (const auto& [owner, item] : pairs) add(owner, item);
  });
  ASSERT_EQ(groups.size(), 40u);
  EXPECT_EQ(groups.items().size(), pairs.size());
  for (std::uint32_t owner = 0; owner < 40; ++owner) {
    EXPECT_EQ(listed(groups[owner]), expected[owner]);
    EXPECT_EQ(groups.first(owner + 1) - groups.first(owner), expected[owner].size());
  }
}

TEST(Groups, MayBeEmpty) {
  EXPECT_EQ(Groups<>().size(), 0u);
  const Groups<> none(0, [](const auto&) {});
  EXPECT_EQ(none.size(), 0u);
  const Groups<> hollow(3, [](const auto& add) { add(1, 7); });
  EXPECT_TRUE(hollow[0].empty());
  EXPECT_EQ(listed(hollow[1]), std::vector<std::uint32_t>{7});
  EXPECT_TRUE(hollow[2].empty());
}

TEST(Groups, ByOwnerAreAscending) {
  const Groups<> groups = group_by_owner(3, 10, [](std::uint32_t i) { return i % 3; });
  EXPECT_EQ(listed(groups[0]), (std::vector<std::uint32_t>{0, 3, 6, 9}));
  EXPECT_EQ(listed(groups[2]), (std::vector<std::uint32_t>{2, 5, 8}));
}

TEST(Groups, ByOwnerAreTheSameOnAnyNumberOfThreads) {
  const auto owner_of = [](std::uint32_t i) { return i % 5 == 3 ? kNoOwner : i * 2654435761u % 70'001; };
  const auto make = [&](int threads) {
    const ThreadLimit limit(threads);
    return group_by_owner(70'001, 200'000, owner_of);
  };
  const Groups<> one = make(1), three = make(3);
  EXPECT_EQ(one.items().size(), 160'000u);
  EXPECT_TRUE(std::ranges::equal(one.items(), three.items()));
  for (std::uint32_t owner = 0; owner <= 70'001; ++owner) ASSERT_EQ(one.first(owner), three.first(owner));
  for (std::uint32_t owner = 0; owner < 70'001; ++owner)
    for (const std::uint32_t i : one[owner]) ASSERT_EQ(owner_of(i), owner);
}

TEST(Groups, OfFewOwnersAreTheSameOnAnyNumberOfThreads) {
  const auto owner_of = [](std::uint32_t i) { return i % 5 == 3 ? kNoOwner : i * 2654435761u % 1001; };
  const auto make = [&](int threads) {
    const ThreadLimit limit(threads);
    return group_by_owner(1001, 20'000, owner_of);
  };
  const Groups<> one = make(1);
  for (const int threads : {2, 3, 8}) {
    const Groups<> several = make(threads);
    EXPECT_TRUE(std::ranges::equal(one.items(), several.items()));
    for (std::uint32_t owner = 0; owner <= 1001; ++owner) ASSERT_EQ(one.first(owner), several.first(owner));
  }
}

TEST(Groups, OfRowsAtVerticesNameEachRowAtEachOfItsVertices) {
  const std::vector<std::array<std::uint32_t, 3>> triangles{{0, 1, 2}, {2, 1, 3}};
  const Groups<> at = rows_at_vertices(5, triangles);
  EXPECT_EQ(listed(at[0]), std::vector<std::uint32_t>{0});
  EXPECT_EQ(listed(at[1]), (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(listed(at[3]), std::vector<std::uint32_t>{1});
  EXPECT_TRUE(at[4].empty());
}

}  // namespace
}  // namespace octafront
