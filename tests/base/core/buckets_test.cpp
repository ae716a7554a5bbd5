#include "base/core/buckets.h"

#include "base/core/thread_limit.h"

#include <map>

#include <gtest/gtest.h>

namespace octafront {
namespace {

TEST(Buckets, HoldTheItemsInOrderOnAnyNumberOfThreads) {
  constexpr std::uint32_t kNumbers = 50'021;
  const auto visit = [](std::size_t i, const auto& add) {
    for (std::size_t k = 0; k < i % 3; ++k) add((i * 7 + k) % 11, static_cast<std::uint32_t>(10 * i + k));
  };
  std::map<std::size_t, std::vector<std::uint32_t>> expected;
  for (std::size_t i = 0; i < kNumbers; ++i)
    visit(i, [&](std::size_t bucket, std::uint32_t item) { expected[bucket].push_back(item); });
  for (const int threads : {1, 2, 5}) {
    const ThreadLimit limit(threads);
    const Buckets<> buckets(kNumbers, 12, visit);
    ASSERT_EQ(buckets.size(), 12u);
    for (std::size_t b = 0; b < 12; ++b)
      EXPECT_EQ((std::vector<std::uint32_t>{buckets[b].begin(), buckets[b].end()}), expected[b]) << b;
  }
}

TEST(Buckets, MayBeEmpty) {
  const Buckets<> none(0, 3, [](std::size_t, const auto&) {});
  EXPECT_EQ(none.size(), 3u);
  EXPECT_TRUE(none[2].empty());
}

TEST(RangeBuckets, CoverTheNumbersInOrder) {
  for (const std::size_t n : {0, 1, 255, 256, 257, 100'000}) {
    const RangeBuckets ranges(n);
    EXPECT_LE(ranges.count(), static_cast<std::size_t>(RangeBuckets::kMostBuckets));
    std::size_t next = 0;
    for (std::size_t b = 0; b < ranges.count(); ++b) {
      EXPECT_EQ(ranges.begin(b), next);
      for (; next < ranges.end(b); ++next) ASSERT_EQ(ranges.of(next), b);
    }
    EXPECT_EQ(next, n);
  }
}

}  // namespace
}  // namespace octafront
