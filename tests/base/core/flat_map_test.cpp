#include "base/core/flat_map.h"

#include "support/random.h"

#include <map>
#include <type_traits>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using Face = std::array<std::uint32_t, 3>;
using Edge = std::array<std::uint32_t, 2>;

template <class Key>
Key key_of(std::uint32_t i) {
  if constexpr (std::is_same_v<Key, Face>)
    return {i % 7, i % 11 + 7, i};
  else if constexpr (std::is_same_v<Key, Edge>)
    return {i % 13, i};
  else
    return static_cast<Key>(i) << 12;  // keys that differ in their upper bits only
}

template <class Key>
class FlatMapOf : public ::testing::Test {};
using KeyTypes = ::testing::Types<std::uint64_t, std::uint32_t, Edge, Face>;
TYPED_TEST_SUITE(FlatMapOf, KeyTypes);

TYPED_TEST(FlatMapOf, AgreesWithStdMapUnderAnySequenceOfOperations) {
  testing::Random random(1);
  FlatMap<TypeParam, int> map;
  std::map<TypeParam, int> expected;
  for (int step = 0; step < 20000; ++step) {
    const TypeParam key = key_of<TypeParam>(static_cast<std::uint32_t>(random.integer(0, 999)));
    if (random.integer(0, 2) == 0) {
      EXPECT_EQ(map.erase(key), expected.erase(key) == 1);
    } else {
      const int value = map.find_or_add(key, step);
      EXPECT_EQ(value, expected.try_emplace(key, step).first->second);
    }
    ASSERT_EQ(map.size(), expected.size());
  }
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const auto it = expected.find(key_of<TypeParam>(i));
    const int* found = map.find(key_of<TypeParam>(i));
    ASSERT_EQ(found != nullptr, it != expected.end());
    if (found != nullptr) {
      EXPECT_EQ(*found, it->second);
    }
  }
}

TYPED_TEST(FlatMapOf, IsEmptyAfterReset) {
  FlatMap<TypeParam, int> map;
  for (std::uint32_t i = 0; i < 100; ++i) map.find_or_add(key_of<TypeParam>(i)) = 1;
  for (const std::size_t expected : {0, 5, 1000}) {
    map.reset(expected);
    EXPECT_EQ(map.size(), 0u);
    for (std::uint32_t i = 0; i < 100; ++i) EXPECT_FALSE(map.contains(key_of<TypeParam>(i)));
    map.find_or_add(key_of<TypeParam>(3)) = 1;
    EXPECT_TRUE(map.contains(key_of<TypeParam>(3)));
  }
}

TEST(FlatMap, KeepsItsValuesWhenRoomIsMade) {
  FlatMap<std::uint64_t, int> map;
  for (std::uint64_t i = 0; i < 10; ++i) map.find_or_add(i, static_cast<int>(i));
  map.reserve(10000);
  for (std::uint64_t i = 0; i < 10; ++i) EXPECT_EQ(*map.find(i), static_cast<int>(i));
}

TEST(FlatSet, SaysWhetherAKeyIsNew) {
  FlatSet<Edge> set;
  EXPECT_TRUE(set.insert({1, 2}));
  EXPECT_FALSE(set.insert({1, 2}));
  EXPECT_TRUE(set.contains({1, 2}));
  EXPECT_FALSE(set.contains({2, 1}));
  EXPECT_TRUE(set.erase({1, 2}));
  EXPECT_FALSE(set.erase({1, 2}));
  EXPECT_EQ(set.size(), 0u);
}

}  // namespace
}  // namespace octafront
