#include "base/geometry/homogeneous.h"

#include "base/geometry/predicates.h"
#include "support/random.h"

#include <gtest/gtest.h>

namespace octafront::exact {
namespace {

Vec3 any_corner(testing::Random& random) {
  return {random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
}

TEST(Homogeneous, SidesOfAPlaneAreThoseOfOrient3d) {
  testing::Random random(3);
  for (int i = 0; i < 200; ++i) {
    const Vec3 a = any_corner(random), b = any_corner(random), c = any_corner(random), d = any_corner(random);
    EXPECT_EQ(value(plane_through(a, b, c), homogeneous(d)).sign(), orient3d(a, b, c, d));
    EXPECT_EQ(value(plane_through(homogeneous(a), homogeneous(b), homogeneous(c)), homogeneous(d)).sign(),
              orient3d(a, b, c, d));
    EXPECT_EQ(value(plane_through(a, b, c), homogeneous(b)).sign(), 0);
  }
}

TEST(Homogeneous, WhereALineMeetsAPlaneIsOnThePlaneAndOnTheLine) {
  testing::Random random(4);
  for (int i = 0; i < 200; ++i) {
    const Vec3 a = any_corner(random), b = any_corner(random), c = any_corner(random);
    const Vec3 p = any_corner(random), q = any_corner(random), aside = any_corner(random);
    const Homogeneous plane = plane_through(a, b, c);
    const Homogeneous at = with_positive_weight(line_meets_plane(homogeneous(p), homogeneous(q), plane));
    EXPECT_GT(at[3].sign(), 0);
    EXPECT_EQ(value(plane, at).sign(), 0);
    EXPECT_EQ(value(plane_through(p, q, aside), at).sign(), 0);
    // The same point by three planes.
    const Homogeneous again = with_positive_weight(
        plane_through(plane, plane_through(p, q, aside), plane_through(p, q, aside + Vec3{0, 0, 5})));
    for (int k = 0; k < 3; ++k) EXPECT_EQ(det2(at[k], at[3], again[k], again[3]).sign(), 0);
    EXPECT_EQ(rounded(at), rounded(again));
  }
}

}  // namespace
}  // namespace octafront::exact
