#include "core/parallel.h"

#include "core/thread_limit.h"

#include <algorithm>
#include <atomic>
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
