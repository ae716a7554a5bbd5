// What several threads would make of a run, as bench/run/threads.py measures it.

#include "../../../bench/run/forecast.h"

#include <stdexcept>

#include <gtest/gtest.h>

namespace octafront {
namespace {

/// Works for so many milliseconds of CPU time.
void work(double milliseconds) {
  const double end = thread_cpu_seconds() + 1e-3 * milliseconds;
  while (thread_cpu_seconds() < end) {
  }
}

TEST(Forecast, EvenTasksAreShared) {
  const Forecast found = forecast_region(8, [](std::size_t) { work(2); });
  EXPECT_EQ(found.regions, 1);
  EXPECT_GE(found.parallel, 0.015);
  EXPECT_GE(found.with[0], found.parallel / 2);
  EXPECT_LT(found.with[0], 0.8 * found.parallel);
  EXPECT_GE(found.with[2], found.parallel / 8);  // there are no more than eight tasks
  EXPECT_LT(found.with[2], 0.5 * found.parallel);
}

TEST(Forecast, TheLongestTaskIsABound) {
  const Forecast found = forecast_region(9, [](std::size_t i) { work(i == 8 ? 20 : 1); });
  EXPECT_GE(found.with[2], 0.019);
  EXPECT_GE(found.with[0], found.with[1]);
  EXPECT_GE(found.with[1], found.with[2]);
  EXPECT_LE(found.with[0], found.parallel);
}

TEST(Forecast, RegionsInsideATaskAreShared) {
  const Forecast found =
      forecast_region(1, [](std::size_t) { work(4), forecast_region(8, [](std::size_t) { work(2); }); });
  EXPECT_EQ(found.regions, 2);
  EXPECT_GE(found.with[2], 0.0055);
  EXPECT_LT(found.with[2], 0.75 * found.parallel);
}

TEST(Forecast, WhatGainsNothingIsSerial) {
  EXPECT_EQ(seconds_shared(64, {5e-6, 5e-6}, 10e-6), 10e-6);
  EXPECT_LT(seconds_shared(64, {5e-3, 5e-3}, 10e-3), 10e-3);
}

TEST(Forecast, WhatATaskThrowsComesOut) {
  EXPECT_THROW(forecast_region(2, [](std::size_t) { throw std::runtime_error("two"); }), std::runtime_error);
}

}  // namespace
}  // namespace octafront
