#include "base/core/parallel_arrays.h"

#include "base/core/thread_limit.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

TEST(RawVector, HoldsWhatItIsGiven) {
  RawVector<int> numbers(3, 7);
  numbers.push_back(8);
  EXPECT_EQ(numbers, (RawVector<int>{7, 7, 7, 8}));
  RawVector<std::string> words(2);  // what is not plain is made as ever
  EXPECT_EQ(words[1], "");
}

TEST(ParallelArrays, CopiesFillsAndFindsTheGreatest) {
  for (const std::size_t n : {0, 1, 100'003}) {
    const RawVector<std::uint32_t> filled = parallel_filled(n, 7u);
    EXPECT_EQ(std::count(filled.begin(), filled.end(), 7u), static_cast<std::ptrdiff_t>(n));
    std::vector<int> numbers(n);
    for (std::size_t i = 0; i < n; ++i) numbers[i] = static_cast<int>(i * 7919 % 100'003);
    EXPECT_TRUE(std::ranges::equal(parallel_copy(numbers), numbers));
    const int greatest = n == 0 ? -1 : *std::ranges::max_element(numbers);
    EXPECT_EQ(parallel_max(n, -1, [&](std::size_t i) { return numbers[i]; }), greatest);
  }
}

TEST(ParallelArrays, NumbersInOrder) {
  constexpr std::size_t kMany = 50'021;
  const auto is_one = [](std::size_t i) { return i % 3 == 1; };
  for (const int threads : {1, 4}) {
    const ThreadLimit limit(threads);
    std::vector<std::size_t> number(kMany, kMany);
    const auto count = [&](std::size_t begin, std::size_t end) {
      std::size_t sum = 0;
      for (std::size_t i = begin; i < end; ++i) sum += is_one(i);
      return sum;
    };
    const std::size_t all = number_in_blocks(kMany, count, [&](std::size_t begin, std::size_t end, std::size_t next) {
      for (std::size_t i = begin; i < end; ++i)
        if (is_one(i)) number[i] = next++;
      return next;
    });
    EXPECT_EQ(all, (kMany + 1) / 3);
    for (std::size_t i = 0; i < kMany; ++i) ASSERT_EQ(number[i], is_one(i) ? i / 3 : kMany);
  }
}

TEST(ParallelArrays, SumsInOrderAreThoseOfALoop) {
  constexpr std::size_t kMany = 30'011;
  const auto term = [](std::size_t i) { return 1.0 / (1.0 + static_cast<double>(i * i % 1009)); };
  double sum = 0;
  for (std::size_t i = 0; i < kMany; ++i) sum += term(i);
  for (const int threads : {1, 4}) {
    const ThreadLimit limit(threads);
    EXPECT_EQ(sum_in_order(kMany, term), sum);
  }
}

TEST(ParallelArrays, CollectedPartsAreJoinedInTheirOrder) {
  const auto evens = [](std::size_t begin, std::size_t end, std::vector<std::size_t>& out) {
    for (std::size_t i = begin; i < end; ++i)
      if (i % 2 == 0) out.push_back(i);
  };
  const auto plain = parallel_collect<std::size_t>(10'001, 100, evens);
  const auto raw = parallel_collect<std::size_t, RawVector<std::size_t>>(10'001, 100, evens);
  ASSERT_EQ(raw.size(), 5'001u);
  EXPECT_TRUE(std::ranges::equal(raw, plain));
  for (std::size_t i = 0; i < raw.size(); ++i) ASSERT_EQ(raw[i], 2 * i);
}

}  // namespace
}  // namespace octafront
