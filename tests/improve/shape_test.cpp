#include "improve/shape.h"

#include "geometry/predicates.h"
#include "support/random.h"

#include <cmath>

#include <gtest/gtest.h>

namespace octafront::improve {
namespace {

// A NaN passes every comparison that it should fail: inverted elements were taken, and passes never ended.
TEST(Shape, OfFlatElementsIsANumber) {
  testing::Random random(1);
  const auto point = [&] {
    const double x = random.unit(), y = random.unit();
    return Vec3{x, y, random.magnitude(1e-17, 1e-12)};
  };
  for (int i = 0; i < 20000; ++i) {
    const Vec3 a = point(), b = point(), c = point(), d = point();
    const Shape s = shape_of(a, b, c, d);
    EXPECT_LE(std::abs(s.beta), 1);
    EXPECT_GE(s.small, 0);
    EXPECT_GE(s.large, 0);
    ASSERT_EQ(s.score, s.score) << "sign " << orient3d(a, b, c, d);
  }
}

}  // namespace
}  // namespace octafront::improve
