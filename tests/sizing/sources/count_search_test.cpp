#include "sizing/sources/budget.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

namespace octafront {
namespace {

/// How many tries it takes until a count is within a tenth of 1000; 20: more.
int tries_by(const std::function<double(double factor)>& count) {
  CountSearch search(1000);
  int tries = 1;
  for (search.came_out(count(1)); search.least_miss() > 0.1 && tries < 20; ++tries) {
    search.step();
    search.came_out(count(search.factor()));
  }
  return tries;
}

TEST(CountSearch, MeetsWhatFollowsTheVolumeAtOnce) {
  EXPECT_EQ(tries_by([](double h) { return 64'000 / (h * h * h); }), 2);
}

TEST(CountSearch, LearnsTheSlope) {
  EXPECT_LE(tries_by([](double h) { return 200 / h; }), 3);
  EXPECT_LE(tries_by([](double h) { return 500 + 40'000 / (h * h * h); }), 8);
}

TEST(CountSearch, ClosesInOnACountThatJumps) {
  EXPECT_LE(tries_by([](double h) { return h < 1.7 ? 5000 / h : 1700 / h; }), 6);
}

/// Details of the surface decide at first, and are gone at sizes that outgrow them.
TEST(CountSearch, FallsOffNoCliff) {
  EXPECT_LE(tries_by([](double h) { return h < 1.5 ? 2600 / std::pow(h, 0.35) : h < 5 ? 5000 / (h * h) : 6; }), 5);
}

TEST(CountSearch, KnowsTheBestAndWhatIsMissing) {
  CountSearch search(1000);
  search.came_out(2000);
  EXPECT_TRUE(search.is_best());
  EXPECT_DOUBLE_EQ(search.missing(), std::log(0.5));
  search.step(-1);
  EXPECT_DOUBLE_EQ(search.factor(), 2);
  search.came_out(100);
  EXPECT_FALSE(search.is_best());
  EXPECT_DOUBLE_EQ(search.least_miss(), std::log(2.0));
  search.step();
  EXPECT_GT(search.factor(), 1);
  EXPECT_LT(search.factor(), 2);
}

TEST(CountSearch, SeesThatLimitsDecide) {
  CountSearch search(1000);
  search.came_out(3000);
  EXPECT_FALSE(search.stands_still());
  search.step();
  search.came_out(2999);
  EXPECT_FALSE(search.stands_still()) << "one step says little";
  search.step();
  search.came_out(2998);
  EXPECT_TRUE(search.stands_still());
  search.step();
  search.came_out(2000);
  EXPECT_FALSE(search.stands_still());
}

}  // namespace
}  // namespace octafront
