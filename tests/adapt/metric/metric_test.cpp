#include "adapt/metric/metric.h"

#include <cmath>

#include <gtest/gtest.h>

namespace octafront::adapt {
namespace {

Metric turned() {
  const Vec3 u = normalized({1, 2, 3}), v = normalized(cross(u, {0, 0, 1})), w = cross(u, v);
  return Eigen{{1e6, 100, 4}, {u, v, w}}.tensor();
}

TEST(Metric, EigenvaluesAreThoseItWasMadeOf) {
  Eigen e = eigen(turned());
  std::sort(e.value.begin(), e.value.end());
  EXPECT_NEAR(e.value[0], 4, 1e-8);
  EXPECT_NEAR(e.value[1], 100, 1e-8);
  EXPECT_NEAR(e.value[2], 1e6, 1e-5);
}

TEST(Metric, LogarithmAndBackIsTheSame) {
  const Metric m = turned(), back = exp_of(log_of(m));
  EXPECT_NEAR(back.xx / m.xx, 1, 1e-9);
  EXPECT_NEAR(back.yz / m.yz, 1, 1e-9);
  EXPECT_NEAR(density_of(m), std::sqrt(4.0 * 100 * 1e6), 1e-3);
}

TEST(Metric, InverseTimesItselfIsOne) {
  const Metric m = turned(), i = inverse(m);
  const Vec3 e = i.times(m.times({1, -2, 0.5}));
  EXPECT_NEAR(e.x, 1, 1e-8);
  EXPECT_NEAR(e.y, -2, 1e-8);
  EXPECT_NEAR(e.z, 0.5, 1e-8);
}

TEST(Metric, MeanOfLengthsIsLogarithmic) {
  for (const double b : {1.0, 1.0000001, 1.1, 1.4, 1.5, 2.0, 100.0})
    EXPECT_NEAR(log_mean(1, b), b == 1 ? 1 : (b - 1) / std::log1p(b - 1), 1e-9 * b) << b;
  EXPECT_EQ(log_mean(2, 3), log_mean(3, 2));
}

TEST(Metric, RegularElementIsWorthOneInItsMetric) {
  // Stretched by 10 along z, and a metric that asks for that.
  const Metric m{1, 0, 0, 1, 0, 0.01};
  const double r = std::sqrt(3.0);
  const Vec3 a{0, 0, 0}, b{1, 0, 0}, c{0.5, r / 2, 0}, d{0.5, r / 6, 10 * std::sqrt(2.0 / 3)};
  const double six = dot(cross(b - a, c - a), d - a);
  EXPECT_NEAR(metric_score(six, m, density_of(m), a, b, c, d), 1, 1e-12);
  EXPECT_NEAR(quality_of_score(0.125), 0.25, 1e-12);
  EXPECT_LT(metric_score(six, Metric{}, 1, a, b, c, d), 0.1);
  EXPECT_LT(metric_score(-six, m, density_of(m), a, c, b, d), 0);
}

TEST(Metric, ImpliedMetricMakesAllEdgesOne) {
  const std::array<Vec3, 4> p{Vec3{0, 0, 0}, Vec3{3, 0.2, 0}, Vec3{0.5, 0.01, 0.3}, Vec3{1, 7, 0.2}};
  const bool positive = dot(cross(p[1] - p[0], p[2] - p[0]), p[3] - p[0]) > 0;
  const Metric m = implied_metric(p[0], p[positive ? 1 : 2], p[positive ? 2 : 1], p[3]);
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < i; ++j) EXPECT_NEAR(m.squared(p[i] - p[j]), 1, 1e-9);
}

TEST(Metric, StepsComeNearerAndArrive) {
  const Metric to = turned();
  Metric at;
  bool arrived = false;
  int steps = 0;
  for (; !arrived; ++steps) {
    ASSERT_LT(steps, 12);
    const Metric before = at;
    at = step_towards(before, to, 2, arrived);
    for (const Vec3 e : {Vec3{1, 0, 0}, Vec3{0, 1, 2}, Vec3{-1, 2, 3}}) {
      const double ratio = std::sqrt(at.squared(e) / before.squared(e));
      EXPECT_LE(ratio, 2.0001);
      EXPECT_GE(ratio, 0.4999);
    }
  }
  EXPECT_EQ(at, to);
  EXPECT_EQ(steps, 10);  // of 1000 times the length
}

}  // namespace
}  // namespace octafront::adapt
