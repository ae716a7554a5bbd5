#include "fill/front/kernel_point.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace octafront {
namespace {

const Box3 kBox{{-2, -2, -2}, {2, 2, 2}};

TEST(KernelPoint, OfACubeIsItsMiddle) {
  const std::vector<HalfSpace> cube{{{1, 0, 0}, -1},  {{-1, 0, 0}, -1}, {{0, 1, 0}, -1},
                                    {{0, -1, 0}, -1}, {{0, 0, 1}, -1},  {{0, 0, -1}, -1}};
  const KernelPoint k = deepest_point(cube, kBox);
  EXPECT_NEAR(k.depth, 1, 1e-12);
  EXPECT_NEAR(length(k.at), 0, 1e-12);
}

TEST(KernelPoint, OfACornerIsItsInscribedBallsCentre) {
  const double s = 1 / std::sqrt(3.0);
  const std::vector<HalfSpace> corner{{{1, 0, 0}, 0}, {{0, 1, 0}, 0}, {{0, 0, 1}, 0}, {{-s, -s, -s}, -s}};
  const double r = 1 / (3 + std::sqrt(3.0));
  const KernelPoint k = deepest_point(corner, kBox);
  EXPECT_NEAR(k.depth, r, 1e-12);
  EXPECT_NEAR(distance(k.at, {r, r, r}), 0, 1e-12);
}

TEST(KernelPoint, DepthIsNegativeWhereTheKernelIsEmpty) {
  const std::vector<HalfSpace> apart{{{1, 0, 0}, 0.5}, {{-1, 0, 0}, 0.5}};
  EXPECT_NEAR(deepest_point(apart, kBox).depth, -0.5, 1e-12);
}

/// No point of a random search is deeper, and the answer is as deep as it says.
TEST(KernelPoint, NoRandomPointLiesDeeper) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int trial = 0; trial < 200; ++trial) {
    SCOPED_TRACE(trial);
    std::vector<HalfSpace> planes;
    const int n = 4 + trial;
    for (int i = 0; i < n; ++i) {
      const double x = normal(random), y = normal(random);
      planes.push_back({normalized({x, y, normal(random)}), 0.5 * unit(random) - 0.3});
    }
    const auto depth = [&](Vec3 p) {
      double least = 1e9;
      for (const HalfSpace& h : planes) least = std::min(least, dot(h.n, p) - h.d);
      return least;
    };
    const KernelPoint k = deepest_point(planes, kBox);
    EXPECT_NEAR(k.depth, depth(k.at), 1e-12);
    EXPECT_TRUE(kBox.contains(k.at * (1 - 1e-9)));
    for (double radius = 2; radius > 1e-4; radius /= 2)
      for (int i = 0; i < 20; ++i) {
        const double x = unit(random), y = unit(random);
        const Vec3 p = k.at + Vec3{x, y, unit(random)} * radius;
        if (kBox.contains(p)) {
          EXPECT_LE(depth(p), k.depth + 1e-9);
        }
      }
  }
}

TEST(KernelPoint, ScaleAndPlaceDoNotMatter) {
  for (const double scale : {1e-6, 1.0, 1e6}) {
    const Vec3 shift{3 * scale, -7 * scale, 5 * scale};
    std::vector<HalfSpace> cube;
    for (int axis = 0; axis < 3; ++axis)
      for (const double sign : {1.0, -1.0}) {
        Vec3 n;
        n[axis] = sign;
        cube.push_back({n, dot(n, shift) - scale});
      }
    const KernelPoint k = deepest_point(cube, {shift - Vec3{1, 1, 1} * scale, shift + Vec3{1, 1, 1} * scale});
    EXPECT_NEAR(k.depth / scale, 1, 1e-9);
  }
}

}  // namespace
}  // namespace octafront
