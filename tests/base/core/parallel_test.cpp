#include "base/core/parallel.h"

#include "base/core/thread_limit.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

TEST(Parallel, EveryIndexOnce) {
  for (const Split split : {Split::kAdaptive, Split::kSingly})
    for (const std::size_t n : {std::size_t{0}, std::size_t{1}, std::size_t{10'007}}) {
      std::vector<int> calls(n);
      parallel_for(
          n, [&](std::size_t i) { ++calls[i]; }, split);
      EXPECT_EQ(std::count(calls.begin(), calls.end(), 1), static_cast<std::ptrdiff_t>(n));
    }
}

TEST(Parallel, NumbersWhatPassesATestInOrder) {
  for (const std::size_t n : {std::size_t{0}, std::size_t{5}, std::size_t{100'003}}) {
    std::vector<std::size_t> numbered(n, n);
    const auto passes = [](std::size_t i) { return i % 3 == 1; };
    const std::size_t all = parallel_number(n, passes, [&](std::size_t i, std::size_t k) { numbered[i] = k; });
    EXPECT_EQ(all, (n + 1) / 3);
    for (std::size_t i = 0, k = 0; i < n; ++i) EXPECT_EQ(numbered[i], passes(i) ? k++ : n) << i;
  }
}

TEST(Parallel, AHookDoesAllTasksItself) {
  static std::size_t regions, tasks;
  regions = tasks = 0;
  constexpr ParallelHook kHook{7, [](std::size_t n, FunctionRef<void(std::size_t)> task) {
                                 ++regions, tasks += n;
                                 for (std::size_t k = 0; k < n; ++k) task(k);
                               }};
  set_parallel_hook(&kHook);
  std::vector<int> calls(10'007);
  parallel_for(calls.size(), [&](std::size_t i) { ++calls[i]; });
  parallel_for(
      3, [&](std::size_t i) { ++calls[i]; }, Split::kSingly);
  parallel_invoke([&] { ++calls[3]; }, [&] { ++calls[4]; });
  const std::size_t believed = thread_count();
  set_parallel_hook(nullptr);
  EXPECT_EQ(believed, 7);
  EXPECT_EQ(regions, 3);
  EXPECT_EQ(tasks, 256 + 3 + 2);
  EXPECT_EQ(std::count(calls.begin(), calls.begin() + 5, 2), 5);
  EXPECT_EQ(std::count(calls.begin() + 5, calls.end(), 1), static_cast<std::ptrdiff_t>(calls.size()) - 5);
  EXPECT_NE(thread_count(), 7);
}

TEST(Parallel, WhatABodyThrowsComesOut) {
  const auto fail = [](std::size_t i) {
    if (i == 17) throw std::runtime_error("seventeen");
  };
  EXPECT_THROW(parallel_for(1000, fail), std::runtime_error);
  EXPECT_THROW(parallel_invoke([&] { fail(17); }, [] {}), std::runtime_error);
}

TEST(Parallel, InvokesBoth) {
  int a = 0, b = 0;
  parallel_invoke([&] { a = 1; }, [&] { b = 2; });
  EXPECT_EQ(a, 1);
  EXPECT_EQ(b, 2);
}

TEST(Parallel, FindsTheFirst) {
  for (const std::size_t n : {0, 1, 100'000}) {
    EXPECT_EQ(parallel_find(n, [](std::size_t) { return false; }), n);
    EXPECT_EQ(parallel_find(n, [n](std::size_t i) { return i % 777 == 776 || i + 1 == n; }),
              std::min<std::size_t>(n - (n > 0), 776));
  }
}

TEST(Parallel, SumsAreTheSameOnAnyNumberOfThreads) {
  const auto part = [](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += 1 / (1.0 + static_cast<double>(i));
    return sum;
  };
  const double expected = parallel_sum(1'000'000, part);
  EXPECT_NEAR(expected, 14.392726722865, 1e-9);
  for (const int threads : {1, 2, 7}) {
    const ThreadLimit limit(threads);
    EXPECT_EQ(parallel_sum(1'000'000, part), expected);
  }
  EXPECT_EQ(parallel_sum(0, part), 0);
}

TEST(Parallel, SortsAsOneThreadDoes) {
  for (const std::size_t n : {0, 1, 20'000, 300'007}) {
    std::vector<std::uint64_t> items(n);
    for (std::size_t i = 0; i < n; ++i) items[i] = i % 5 == 0 ? 42 : i * 0x9e3779b97f4a7c15u;  // many equal ones
    std::vector<std::uint64_t> expected = items;
    std::sort(expected.begin(), expected.end());
    for (const int threads : {1, 2, 3, 16}) {
      const ThreadLimit limit(threads);
      std::vector<std::uint64_t> sorted = items;
      parallel_sort(sorted);
      EXPECT_EQ(sorted, expected);
    }
  }
}

TEST(Parallel, KeepsToItsThreads) {
  const auto caller = std::this_thread::get_id();
  std::atomic<int> elsewhere = 0;
  const ThreadLimit one(1);
  parallel_for(1000, [&](std::size_t) { elsewhere += std::this_thread::get_id() != caller; });
  EXPECT_EQ(elsewhere, 0);
}

TEST(PerThread, MakesOneForEachAndDropsThem) {
  static std::atomic<int> alive = 0;
  struct Counted {
    Counted() { ++alive; }
    Counted(const Counted&) = delete;
    ~Counted() { --alive; }
    std::vector<std::size_t> seen;
  };
  {
    PerThread<Counted> scratch;
    parallel_for(10'000, [&](std::size_t i) { scratch.local().seen.push_back(i); });
    std::vector<std::size_t> all;
    int threads = 0;
    scratch.for_each([&](const Counted& c) {
      ++threads;
      all.insert(all.end(), c.seen.begin(), c.seen.end());
    });
    EXPECT_EQ(threads, alive);
    std::sort(all.begin(), all.end());
    std::vector<std::size_t> expected(10'000);
    std::iota(expected.begin(), expected.end(), std::size_t{0});
    EXPECT_EQ(all, expected);
  }
  EXPECT_EQ(alive, 0);
}

}  // namespace
}  // namespace octafront
