#include "base/geometry/needle.h"

#include "base/geometry/doubtful_parts.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace octafront {
namespace {

TEST(Needle, SlicesAreTheTriangle) {
  for (const double apex : {0.0, 0.3, 1.0}) {
    const Needle needle({Vec3{0, 0, 0}, Vec3{8, 0, 0}, Vec3{8 * apex, 0.25, 0}});
    EXPECT_TRUE(needle.is_one());
    EXPECT_NEAR(needle.length(), 8, 0.01);
    double area = 0;
    for (int k = 0; k < 10; ++k) {
      area += needle.area(0.1 * k, 0.1 * (k + 1));
      const Vec3 middle = needle.middle(0.1 * k + 0.05);
      EXPECT_GE(middle.y, 0);
      EXPECT_LE(middle.y, 0.125);
      Box3 box;
      const Needle::Corners corners = needle.corners(0.1 * k, 0.1 * (k + 1));
      for (const Vec3 p : corners.span()) box.add(p);
      EXPECT_LE(box.lo.x, middle.x);
      EXPECT_GE(box.hi.x, middle.x);
    }
    EXPECT_NEAR(area, 1, 1e-12);
  }
  EXPECT_FALSE(Needle({Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}}).is_one());
}

TEST(Needle, ALongOneHasPartsInProportionToItsArea) {
  // Halves of longest edges alone would make forty times as many of the long one.
  const auto parts_of = [](double length) {
    int parts = 0;
    const auto look = [](PartCorners, Vec3, double reach) { return reach < 0.05 ? Part::kVisit : Part::kDivide; };
    for_each_doubtful_part({Vec3{0, 0, 0}, Vec3{length, 0, 0}, Vec3{length, 0.1, 0}}, look, [&](Vec3) {
      ++parts;
      return true;
    });
    return parts;
  };
  const int of_short = parts_of(1);
  EXPECT_GT(of_short, 10);
  EXPECT_LT(parts_of(64), 2 * 64 * of_short);
}

TEST(Needle, TheCornersOfItsPartsAreWithinTheirReach) {
  const auto look = [](PartCorners part, Vec3 middle, double reach) {
    for (const Vec3 p : part) EXPECT_LE(distance(p, middle), reach);
    return reach < 0.01 ? Part::kVisit : Part::kDivide;
  };
  EXPECT_TRUE(for_each_doubtful_part({Vec3{0, 0, 0}, Vec3{3, 0, 0}, Vec3{1, 0.1, 0}}, look,
                                     [](Vec3 p) { return p.x >= 0 && p.x <= 3 && p.y >= 0 && p.y <= 0.1; }));
}

}  // namespace
}  // namespace octafront
