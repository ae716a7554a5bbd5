#include "base/geometry/doubtful_parts.h"

#include "support/random.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

constexpr double kLimit = 0.1;

/// Within a distance of the unit ball.
bool near_ball(Vec3 p, double d) {
  return length(p) - 1 < d;
}

constexpr double kFinePart = 0.25;

double finest(Vec3) {
  return kFinePart * kLimit;
}

std::vector<Vec3> doubtful(const TriangleCorners& t) {
  std::vector<Vec3> found;
  for_each_doubtful_part(t, farther_than(kLimit, kLimit, near_ball, finest), [&](Vec3 p) {
    found.push_back(p);
    return true;
  });
  return found;
}

TEST(DoubtfulParts, AreWhereATriangleStrays) {
  testing::Random random(7);
  int strayed = 0;
  for (int round = 0; round < 200; ++round) {
    TriangleCorners t;
    for (Vec3& p : t) p = {random.between(-1.3, 1.3), random.between(-1.3, 1.3), random.between(-1.3, 1.3)};
    const std::vector<Vec3> found = doubtful(t);
    for (int k = 0; k < 200; ++k) {
      double u = random.unit(), v = random.unit();
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const Vec3 p = t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
      if (near_ball(p, kLimit)) continue;
      ++strayed;
      EXPECT_FALSE(found.empty());
    }
    for (const Vec3 q : found) EXPECT_FALSE(near_ball(q, (1 - kFinePart) * kLimit));
  }
  EXPECT_GT(strayed, 1000);
}

TEST(DoubtfulParts, AreFoundWhereOnlyASmallPartStrays) {
  // A tip of .05 beyond the limit on a long triangle.
  const TriangleCorners t{Vec3{1 + kLimit + 0.05, 0, 0}, Vec3{-0.5, 0.4, 0}, Vec3{-0.5, -0.4, 0}};
  const std::vector<Vec3> found = doubtful(t);
  ASSERT_FALSE(found.empty());
  for (const Vec3 q : found) EXPECT_LT(distance(q, t[0]), 0.05 + 2 * kFinePart * kLimit);
}

TEST(DoubtfulParts, AreNotDividedWhereAllIsFar) {
  int asked = 0;
  const auto finest_of_all = [](Vec3) { return 1e-301; };
  for_each_doubtful_part({Vec3{2, 0, 0}, Vec3{0, 2, 0}, Vec3{0, 0, 2}},
                         farther_than(1e-300, 1e-300, near_ball, finest_of_all), [&](Vec3) {
                           ++asked;
                           return true;
                         });
  EXPECT_EQ(asked, 1);
}

TEST(DoubtfulParts, AreAskedForNoLongerOnceFalse) {
  int asked = 0;
  EXPECT_FALSE(for_each_doubtful_part({Vec3{2, 0, 0}, Vec3{3, 0, 0}, Vec3{2, 1, 0}},
                                      farther_than(kLimit, kLimit, near_ball, finest), [&](Vec3) {
                                        ++asked;
                                        return false;
                                      }));
  EXPECT_EQ(asked, 1);
  EXPECT_TRUE(for_each_doubtful_part({Vec3{0.5, 0, 0}, Vec3{0, 0.5, 0}, Vec3{0, 0, 0.5}},
                                     farther_than(kLimit, kLimit, near_ball, finest), [](Vec3) { return false; }));
}

}  // namespace
}  // namespace octafront
