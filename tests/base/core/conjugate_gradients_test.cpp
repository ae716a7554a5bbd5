#include "base/core/conjugate_gradients.h"

#include <gtest/gtest.h>

namespace octafront {
namespace {

constexpr SolverLimits kLimits{.steps = 50, .enough = 1e-24};

TEST(ConjugateGradients, SolvesWhatHasASolution) {
  // A chain of four, and a row of zeros.
  const auto times = [](const std::vector<double>& x) {
    return std::vector<double>{2 * x[0] - x[1], 2 * x[1] - x[0] - x[2], 2 * x[2] - x[1] - x[3], 2 * x[3] - x[2], 0};
  };
  const std::vector<double> x = solved_by_conjugate_gradients({2, 2, 2, 2, 0}, {0, 0, 0, 5, 7}, times, kLimits);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(x[i], i + 1, 1e-12);
  EXPECT_EQ(x[4], 0);
}

TEST(ConjugateGradients, TakesASingularMatrixThatTheRightSideFits) {
  const auto times = [](const std::vector<double>& x) { return std::vector<double>{x[0] - x[1], x[1] - x[0]}; };
  const std::vector<double> x = solved_by_conjugate_gradients({1, 1}, {3, -3}, times, kLimits);
  EXPECT_NEAR(x[0] - x[1], 3, 1e-12);
}

TEST(ConjugateGradients, EndsAfterItsSteps) {
  int steps = 0;
  const auto times = [&](const std::vector<double>& x) {
    ++steps;
    return std::vector<double>{x[0], 100 * x[1], 1e4 * x[2]};
  };
  solved_by_conjugate_gradients({1, 1, 1}, {1, 1, 1}, times, {.steps = 2, .enough = 0});
  EXPECT_EQ(steps, 2);
}

}  // namespace
}  // namespace octafront
