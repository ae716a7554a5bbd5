#include "base/geometry/measures.h"

#include "base/geometry/segment_distance.h"
#include "support/lattice_points.h"

#include <algorithm>
#include <numbers>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

namespace octafront {
namespace {

// Coordinates k / 64 up to 1: coincidences and flat shapes occur.
Vec3 any_measured_point() {
  return testing::lattice_point(64, 1.0 / 64);
}

constexpr Vec3 kRegular[4] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};

TEST(TetMeasures, KnowTheRegularTetrahedron) {
  const auto& [a, b, c, d] = kRegular;
  const double sign = six_volumes(a, b, c, d) > 0 ? 1 : -1;
  EXPECT_NEAR(signed_volume(a, b, c, d), sign * 8.0 / 3, 1e-15);
  EXPECT_NEAR(tet_radius_ratio(a, b, c, d), sign, 1e-14);
  EXPECT_NEAR(tet_radius_ratio(b, a, c, d), -sign, 1e-14);
  EXPECT_NEAR(circumradius(a, b, c, d), std::sqrt(3), 1e-15);
  EXPECT_NEAR(inradius(a, b, c, d), sign / std::sqrt(3), 1e-15);
  for (const double cosine : dihedral_cosines(a, b, c, d)) EXPECT_NEAR(cosine, 1.0 / 3, 1e-15);
  EXPECT_NEAR(triangle_radius_ratio(a, b, c), 1, 1e-15);
  EXPECT_NEAR(circumradius(a, b, c), std::sqrt(8.0 / 3), 1e-15);
  EXPECT_DOUBLE_EQ(longest_squared_edge(a, b, c, d), 8);
}

TEST(TetMeasures, DihedralCosinesFollowTheOrderOfEdges) {
  // Right angles along the three axes; the slanted face meets the others at acos(1 / sqrt 3).
  const auto cosines = dihedral_cosines({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  for (int e = 0; e < 3; ++e) EXPECT_NEAR(cosines[e], 0, 1e-15);
  for (int e = 3; e < 6; ++e) EXPECT_NEAR(cosines[e], 1 / std::sqrt(3), 1e-15);
}

RC_GTEST_PROP(TetMeasures, RadiusRatioIsThreeRadiiAndNeverNaN, ()) {
  const Vec3 a = any_measured_point(), b = any_measured_point(), c = any_measured_point(), d = any_measured_point();
  const double beta = tet_radius_ratio(a, b, c, d);
  RC_ASSERT(std::abs(beta) <= 1 + 1e-12);
  const double det = six_volumes(a, b, c, d);
  if (det == 0) {
    RC_ASSERT(beta == 0);
  } else {
    const double expected = 3 * inradius(a, b, c, d) / circumradius(a, b, c, d);
    RC_ASSERT(std::abs(beta - expected) <= 1e-10);
  }
}

RC_GTEST_PROP(TetMeasures, CircumcentreIsEquidistant, ()) {
  const Vec3 a = any_measured_point(), b = any_measured_point(), c = any_measured_point(), d = any_measured_point();
  RC_PRE(std::abs(six_volumes(a, b, c, d)) > 1e-2);
  const Vec3 o = circumcenter(a, b, c, d);
  for (const Vec3 p : {b, c, d}) RC_ASSERT(std::abs(distance(o, p) - distance(o, a)) < 1e-9);
  const Vec3 t = circumcenter(a, b, c);
  for (const Vec3 p : {b, c}) RC_ASSERT(std::abs(distance(t, p) - distance(t, a)) < 1e-9);
  RC_ASSERT(std::abs(dot(t - a, double_area_normal(a, b, c))) < 1e-9);
}

RC_GTEST_PROP(TriangleMeasures, RadiusRatioIsTwoRadiiAndNeverNaN, ()) {
  const Vec3 a = any_measured_point(), b = any_measured_point(), c = any_measured_point();
  const double ratio = triangle_radius_ratio(a, b, c), area = triangle_area(a, b, c);
  if (area == 0) {
    RC_ASSERT(ratio == 0);
  } else {
    const double inner = 2 * area / (distance(a, b) + distance(b, c) + distance(c, a));
    RC_ASSERT(std::abs(ratio - 2 * inner / circumradius(a, b, c)) <= 1e-9);
    RC_ASSERT(ratio <= 1 + 1e-12);
  }
}

RC_GTEST_PROP(Angles, OfATriangleSumToPi, ()) {
  const Vec3 a = any_measured_point(), b = any_measured_point(), c = any_measured_point();
  RC_PRE(a != b && b != c && c != a);
  RC_ASSERT(std::abs(angle_at(a, b, c) + angle_at(b, c, a) + angle_at(c, a, b) - std::numbers::pi) < 1e-12);
}

RC_GTEST_PROP(Angles, SolidAnglesFromInsideSumToTheSphere, ()) {
  Vec3 a = any_measured_point(), b = any_measured_point(), c = any_measured_point(), d = any_measured_point();
  RC_PRE(std::abs(six_volumes(a, b, c, d)) > 1e-3);
  if (six_volumes(a, b, c, d) < 0) std::swap(a, b);
  const Vec3 m = centroid(a, b, c, d);
  const double sum =
      solid_angle(m, b, c, d) + solid_angle(m, a, d, c) + solid_angle(m, a, b, d) + solid_angle(m, a, c, b);
  RC_ASSERT(std::abs(sum - 4 * std::numbers::pi) < 1e-9);
}

RC_GTEST_PROP(ClosestPoint, OfATriangleBeatsAGridOfItsPoints, ()) {
  const Vec3 a = any_measured_point(), b = any_measured_point(), c = any_measured_point(), p = any_measured_point();
  const Vec3 q = closest_point_on_triangle(p, a, b, c);
  const double nearest = distance(p, q);
  constexpr int kSteps = 12;
  for (int i = 0; i <= kSteps; ++i)
    for (int j = 0; i + j <= kSteps; ++j)
      RC_ASSERT(nearest <= distance(p, (a * i + b * j + c * (kSteps - i - j)) / kSteps) + 1e-12);
  // The answer lies on the triangle: nothing of it is nearer to q than q itself.
  RC_ASSERT(distance(q, closest_point_on_triangle(q, a, b, c)) < 1e-12);
}

RC_GTEST_PROP(SegmentDistance, IsTheLeastOverManyPoints, ()) {
  const Vec3 p = any_measured_point(), q = any_measured_point(), a = any_measured_point(), b = any_measured_point();
  RC_PRE(p != q && a != b);
  constexpr int kSteps = 200;
  double least = distance(p, a);
  for (int i = 0; i <= kSteps; ++i) {
    const Vec3 x = p + (q - p) * (double(i) / kSteps);
    least = std::min(least, distance(x, closest_point_on_segment(x, a, b)));
  }
  const double d = std::sqrt(squared_segment_distance(p, q - p, a, b - a));
  RC_ASSERT(d <= least + 1e-7);
  RC_ASSERT(least <= d + distance(p, q) / kSteps + 1e-7);
}

}  // namespace
}  // namespace octafront
