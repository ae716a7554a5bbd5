#include "improve/shape/shape.h"

#include "base/geometry/predicates.h"
#include "support/random.h"

#include <algorithm>
#include <array>
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

using Objective = ImproveOptions::Objective;

constexpr Objective kObjectives[] = {Objective::kBalanced,    Objective::kBeta,      Objective::kMinDihedral,
                                     Objective::kMaxDihedral, Objective::kMeanRatio, Objective::kSolver};

// Their centre cancels to nothing, and so does the quotient of nothing by nothing that beta was.
TEST(Shape, OfFourPointsOnACircleIsNeverCertain) {
  testing::Random random(3);
  for (int i = 0; i < 20000; ++i) {
    const Vec3 u{random.unit(), random.unit(), random.unit()}, v{random.unit(), -random.unit(), random.unit()},
        middle{random.unit(), random.unit(), random.unit()};
    const Vec3 along = random.magnitude(1e-3, 1) * normalized(u), across = length(along) * normalized(cross(u, v));
    // A rectangle, up to rounding.
    const double flat = random.magnitude(1e-4, 1);
    const Vec3 a = middle - along - flat * across, b = middle + along - flat * across,
               c = middle + along + flat * across, d = middle - along + flat * across;
    ASSERT_LT(shape_of(a, b, c, d).beta, kCertainBeta);
    ASSERT_LT(shape_of(a, c, b, d).beta, kCertainBeta);
  }
}

TEST(Shape, OfTheRegularTetrahedronIsWorthOneForEveryObjective) {
  for (const Objective objective : kObjectives) {
    const Shape s = shape_of({1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}, objective);
    const Shape inverted = shape_of({1, 1, 1}, {-1, 1, -1}, {1, -1, -1}, {-1, -1, 1}, objective);
    const float positive = std::max(s.score, inverted.score), negative = std::min(s.score, inverted.score);
    EXPECT_NEAR(positive, 1, 1e-6) << static_cast<int>(objective);
    EXPECT_LE(negative, 0) << static_cast<int>(objective);
  }
}

/// The solver score, from the definition: circumradius, face angles and edges one by one.
double solver_score(const std::array<Vec3, 4>& p) {
  const Vec3 u = p[1] - p[0], v = p[2] - p[0], w = p[3] - p[0];
  const double six_volumes = dot(cross(u, v), w);
  const Vec3 center =
      (squared_length(u) * cross(v, w) + squared_length(v) * cross(w, u) + squared_length(w) * cross(u, v)) /
      (2 * six_volumes);
  const double radius = length(center), regular = 8 * std::sqrt(3.0) / 27 * radius * radius * radius;
  double worst = six_volumes / 6 / regular, shortest = 1e300, longest = 0;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      if (i == j) continue;
      shortest = std::min(shortest, distance(p[i], p[j]));
      longest = std::max(longest, distance(p[i], p[j]));
      for (int k = 0; k < 4; ++k) {
        if (k == i || k == j) continue;
        const Vec3 a = normalized(p[j] - p[i]), b = normalized(p[k] - p[i]);
        const double angle = std::acos(std::clamp(dot(a, b), -1.0, 1.0)), right = std::acos(0.0);
        worst = std::min({worst, 2 * std::sin(angle / 2), std::cos(angle / 2) / std::cos(right / 3)});
      }
    }
  return std::min(worst, std::sqrt(shortest / longest));
}

TEST(Shape, ScoresAreWhatTheObjectivesSay) {
  testing::Random random(2);
  const auto point = [&] {
    const double x = random.unit(), y = random.unit();
    return Vec3{x, y, random.unit()};
  };
  int seen = 0;
  for (int i = 0; i < 3000; ++i) {
    std::array<Vec3, 4> p{point(), point(), point(), point()};
    if (orient3d(p[0], p[1], p[2], p[3]) < 0) std::swap(p[0], p[1]);
    const auto score = [&](Objective o) { return double{shape_of(p[0], p[1], p[2], p[3], o).score}; };
    const Shape s = shape_of(p[0], p[1], p[2], p[3]);
    if (s.beta < 0.01f) continue;
    ++seen;
    double edges = 0;
    for (int a = 0; a < 4; ++a)
      for (int b = a + 1; b < 4; ++b) edges += squared_length(p[a] - p[b]);
    const double volume = dot(cross(p[1] - p[0], p[2] - p[0]), p[3] - p[0]) / 6;
    const double ratio = 12 * std::pow(3 * volume, 2.0 / 3) / edges;
    EXPECT_NEAR(score(Objective::kMeanRatio), std::pow(ratio, 1.5), 1e-5);
    EXPECT_NEAR(score(Objective::kSolver), solver_score(p), 1e-4);
    EXPECT_NEAR(score(Objective::kBeta), s.beta, 1e-6);
    EXPECT_NEAR(score(Objective::kMinDihedral), std::min(1.0, std::sqrt(kSmallWeight * s.small)), 1e-5);
    EXPECT_NEAR(score(Objective::kMaxDihedral), std::min(1.0, std::sqrt(kLargeWeight * s.large)), 1e-5);
    EXPECT_NEAR(s.score,
                std::min({score(Objective::kBeta), score(Objective::kMinDihedral), score(Objective::kMaxDihedral)}),
                1e-6);
  }
  EXPECT_GT(seen, 1000);
}

/// A star about `center`: faces around it, some of them seen from behind once it is moved.
ShapeBatch random_star(testing::Random& random, int size, Vec3 center, double scale) {
  ShapeBatch star;
  const auto direction = [&] {
    const double x = random.unit() - 0.5, y = random.unit() - 0.5;
    return normalized(Vec3{x, y, random.unit() - 0.5});
  };
  while (star.size < size) {
    const Vec3 b = direction(), c = direction(), d = direction();
    if (dot(cross(b, c), d) > 0.1) star.add(center + scale * b, center + scale * c, center + scale * d);
  }
  return star;
}

// Single precision, whatever the place and the scale of the star, and whatever fills up the last vector.
TEST(Shape, SketchOfAStarIsTheStar) {
  testing::Random random(3);
  for (int size = 1; size < 40; ++size)
    for (const double scale : {1.0, 1e-20, 1e15}) {
      const Vec3 center = scale * Vec3{30, -20, 10};
      ShapeBatch star = random_star(random, size, center, scale);
      StarSketch sketch;
      sketch.take(star, center, scale);
      for (int i = 0; i < 8; ++i) {
        const Vec3 step = 0.2 * Vec3{random.unit(), random.unit(), random.unit()};
        star.evaluate_star(center + scale * step);
        ASSERT_NEAR(sketch.deficit_at(step), star.deficit(), 1e-5 * size) << size << " at scale " << scale;
      }
    }
}

TEST(Shape, OfABatchIsThatOfEachElement) {
  testing::Random random(4);
  for (int size = 1; size < 20; ++size) {
    ShapeBatch star = random_star(random, size, {}, 1);
    star.evaluate_star({0.1, 0, 0});
    for (int i = 0; i < size; ++i) {
      const auto corner = [&](int k) { return Vec3{star.corner[k][0][i], star.corner[k][1][i], star.corner[k][2][i]}; };
      ASSERT_EQ(star.shape(i), shape_of({0.1, 0, 0}, corner(1), corner(2), corner(3)));
    }
  }
}

}  // namespace
}  // namespace octafront::improve
