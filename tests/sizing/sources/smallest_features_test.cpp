#include <octafront/smallest_features.h>

#include "support/named_surfaces.h"

#include <cmath>

#include <gtest/gtest.h>

namespace octafront {
namespace {

TEST(SmallestFeatures, OfABoxAreItsThicknessAndItsShortestEdge) {
  const SmallestFeatures found = smallest_features(testing::box(10, 7, 0.5));
  EXPECT_NEAR(found.thickness, 0.5, 1e-12);
  EXPECT_NEAR(found.shortest_edge, 0.5, 1e-12);
  EXPECT_NEAR(found.thin_tenth, 0.5, 1e-12);
  EXPECT_NEAR(found.thin_half, 0.5, 1e-12) << "its two large sides are more than half of it";
  EXPECT_TRUE(std::abs(found.thinnest_at.z) < 1e-12 || std::abs(found.thinnest_at.z - 0.5) < 1e-12);
}

TEST(SmallestFeatures, OfACubeAreItsSideWhereverOneLooks) {
  const SmallestFeatures found = smallest_features(testing::cube(2));
  EXPECT_NEAR(found.thickness, found.thin_half, 1e-12);
  EXPECT_NEAR(found.thickness, found.shortest_edge, 1e-12);
}

TEST(SmallestFeatures, OfAHollowSphereAreItsWallAndNoEdge) {
  const SmallestFeatures found = smallest_features(testing::hollow_sphere(3, 1, 0.8));
  EXPECT_NEAR(found.thickness, 0.2, 0.02);
  EXPECT_NEAR(found.thin_half, 0.2, 0.02) << "not the way across the cavity";
  EXPECT_EQ(found.shortest_edge, SmallestFeatures::kNone);
}

TEST(SmallestFeatures, AreTheSameForAnyNumberOfThreads) {
  RunContext one, two;
  one.threads = 1, two.threads = 2;
  const SurfaceMesh wall = testing::hollow_sphere(3);
  const SmallestFeatures a = smallest_features(wall, 40, one), b = smallest_features(wall, 40, two);
  EXPECT_EQ(a.thickness, b.thickness);
  EXPECT_EQ(a.thinnest_at, b.thinnest_at);
  EXPECT_EQ(a.thin_tenth, b.thin_tenth);
}

TEST(SmallestFeatures, OfNothingAreNone) {
  const SmallestFeatures found = smallest_features(SurfaceMesh{});
  EXPECT_EQ(found.thickness, SmallestFeatures::kNone);
  EXPECT_EQ(found.shortest_edge, SmallestFeatures::kNone);
}

}  // namespace
}  // namespace octafront
