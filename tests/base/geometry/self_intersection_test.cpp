#include "base/geometry/self_intersection.h"

#include "base/geometry/hausdorff.h"
#include "base/geometry/predicates.h"
#include "support/named_surfaces.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

namespace octafront {
namespace {

using Pairs = std::vector<std::array<std::uint32_t, 2>>;

Pairs all_pairs(const SurfaceMesh& s) {
  Pairs pairs;
  for (std::uint32_t i = 0; i < s.triangles.size(); ++i)
    for (std::uint32_t j = i + 1; j < s.triangles.size(); ++j)
      if (triangles_conflict(s.points, s.triangles[i], s.triangles[j])) pairs.push_back({i, j});
  return pairs;
}

TEST(SelfIntersections, CleanSurfacesHaveNone) {
  for (const SurfaceMesh& s : {SurfaceMesh{}, testing::cube(5), testing::unit_tetrahedron(), testing::icosphere(3),
                               testing::torus(24, 12), testing::hollow_sphere(2)})
    EXPECT_TRUE(self_intersections(s.points, s.triangles).empty());
}

TEST(SelfIntersections, FindTheCurveOfTwoSpheresAndRespectTheLimit) {
  const SurfaceMesh one = testing::icosphere(3);
  const SurfaceMesh two = testing::joined(one, testing::transformed(one, 1, {0.5, 0.1, 0.2}));
  const Pairs expected = all_pairs(two);
  ASSERT_GT(expected.size(), 50u);
  EXPECT_EQ(self_intersections(two.points, two.triangles), expected);
  const Pairs some = self_intersections(two.points, two.triangles, 7);
  EXPECT_EQ(some.size(), 7u);
  for (const auto& pair : some) EXPECT_TRUE(std::binary_search(expected.begin(), expected.end(), pair));
}

TEST(SelfIntersections, DoNotDependOnThreads) {
  const SurfaceMesh one = testing::icosphere(4);
  const SurfaceMesh two = testing::joined(one, testing::transformed(one, 0.9, {0.3, 0.1, 0.2}));
  const auto found = [&](std::size_t limit, std::size_t threads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    return self_intersections(two.points, two.triangles, limit);
  };
  for (const std::size_t limit : {5, 1000000}) EXPECT_EQ(found(limit, 1), found(limit, 4));
}

/// Two discs of needles about their middles, tilted, and a wall between their rims.
SurfaceMesh needle_drum(int needles) {
  SurfaceMesh s;
  s.points = {{0, 0, 0}, {0, 0, 0.3}};
  const auto rim = [&](int i, int level) { return static_cast<VertexIndex>(2 + 2 * (i % needles) + level); };
  for (int i = 0; i < needles; ++i) {
    const double angle = 2 * std::numbers::pi * i / needles;
    for (const double z : {0.0, 0.3}) s.points.push_back({std::cos(angle), std::sin(angle), z});
    s.triangles.push_back({0, rim(i + 1, 0), rim(i, 0)});
    s.triangles.push_back({1, rim(i, 1), rim(i + 1, 1)});
    s.triangles.push_back({rim(i, 0), rim(i + 1, 0), rim(i + 1, 1)});
    s.triangles.push_back({rim(i, 0), rim(i + 1, 1), rim(i, 1)});
  }
  return s;
}

TEST(SelfIntersections, OfFansAreThoseOfAllPairs) {
  SurfaceMesh drum = needle_drum(300);
  EXPECT_TRUE(self_intersections(drum.points, drum.triangles).empty());
  drum.points[2 + 2 * 40].y += 0.1;        // over the next needles of its disc
  drum.points[2 + 2 * 120 + 1].z -= 0.35;  // through the other disc
  drum.points[2 + 2 * 200] = drum.points[2 + 2 * 203];
  const Pairs expected = all_pairs(drum);
  ASSERT_GT(expected.size(), 20u);
  EXPECT_EQ(self_intersections(drum.points, drum.triangles), expected);
}

TEST(SelfIntersections, OfLargeFansTakeLittleTime) {
  // All pairs of a disc's needles have boxes that overlap: hours of work if each is looked at.
  SurfaceMesh drum = needle_drum(100'000);
  EXPECT_TRUE(self_intersections(drum.points, drum.triangles).empty());
  drum.points[2].x += 0.5;
  drum.points[2].y += 0.001;
  EXPECT_FALSE(self_intersections(drum.points, drum.triangles).empty());
}

/// Two cones on one rim, or a cone and a disc.
SurfaceMesh bicone(int sides, double top, double bottom) {
  SurfaceMesh s;
  s.points = {{0, 0, top}, {0, 0, bottom}};
  const auto rim = [&](int i) { return static_cast<VertexIndex>(2 + i % sides); };
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * std::numbers::pi * i / sides;
    s.points.push_back({std::cos(angle), std::sin(angle), 0});
    s.triangles.push_back({0, rim(i), rim(i + 1)});
    s.triangles.push_back({1, rim(i + 1), rim(i)});
  }
  return s;
}

TEST(SelfIntersections, BetweenFansOnOneAxisAreThoseOfAllPairs) {
  SurfaceMesh cone = bicone(300, 1, -0.01);
  EXPECT_TRUE(self_intersections(cone.points, cone.triangles).empty());
  cone.points[1] = {0.9, 0.05, 0.4};  // outside of the upper cone
  const Pairs expected = all_pairs(cone);
  ASSERT_GT(expected.size(), 20u);
  EXPECT_EQ(self_intersections(cone.points, cone.triangles), expected);
}

TEST(SelfIntersections, BetweenFansOnOneAxisTakeLittleTime) {
  // The box of a triangle of the one fan meets those of a quarter of the other: minutes of work if each is looked at.
  for (const double bottom : {0.0, -1.0}) {
    const SurfaceMesh cone = bicone(50'000, 1, bottom);
    EXPECT_TRUE(self_intersections(cone.points, cone.triangles).empty());
  }
}

RC_GTEST_PROP(SelfIntersections, AreThoseOfAllPairs, ()) {
  // One seed, so that RapidCheck shrinks a number and not hundreds of draws.
  std::mt19937_64 random(*rc::gen::resize(100, rc::gen::arbitrary<std::uint64_t>()));
  const auto integer = [&](int lo, int hi) { return std::uniform_int_distribution(lo, hi)(random); };
  SurfaceMesh s;
  for (int i = 0; i < 40; ++i) {
    const int x = integer(-6, 6), y = integer(-6, 6), z = integer(-6, 6);
    s.points.push_back({double(x), double(y), double(z)});
  }
  const auto any_vertex = [&] { return static_cast<VertexIndex>(integer(0, 39)); };
  while (s.triangles.size() < 60) {
    const VertexIndex a = any_vertex(), b = any_vertex();
    const Triangle t{a, b, any_vertex()};
    if (!collinear(s.points[t[0]], s.points[t[1]], s.points[t[2]])) s.triangles.push_back(t);
  }
  RC_ASSERT(self_intersections(s.points, s.triangles) == all_pairs(s));
}

TEST(Hausdorff, OfASurfaceAndItselfIsZero) {
  const SurfaceMesh s = testing::torus(12, 8);
  const HausdorffBounds d = hausdorff_distance(s, s, 1e-3);
  EXPECT_LT(d.upper, 1e-15);
}

TEST(Hausdorff, OfTheSameCubeInOtherTrianglesIsZero) {
  const HausdorffBounds d = hausdorff_distance(testing::cube(2), testing::cube(7), 1e-3);
  EXPECT_LE(d.upper, 1e-3);
  EXPECT_LT(d.lower, 1e-15);
}

TEST(Hausdorff, EnclosesKnownDistances) {
  const double tolerance = 1e-3;
  // A corner of the outer cube is the farthest from the inner one.
  const SurfaceMesh outer = testing::cube(2), inner = testing::transformed(outer, 0.5, {0.25, 0.25, 0.25});
  const HausdorffBounds d = hausdorff_distance(outer, inner, tolerance);
  EXPECT_LE(d.lower, 0.25 * std::numbers::sqrt3 + 1e-12);
  EXPECT_GE(d.upper, 0.25 * std::numbers::sqrt3 - 1e-12);
  EXPECT_LE(d.upper - d.lower, 2 * tolerance);
}

TEST(Hausdorff, IsOneSided) {
  // A part of a surface is no distance away from it, but not the other way round.
  SurfaceMesh part = testing::cube(4);
  const SurfaceMesh whole = part;
  std::erase_if(part.triangles, [&](const Triangle& t) { return part.points[t[0]].x + part.points[t[1]].x > 1.2; });
  EXPECT_LE(one_sided_hausdorff(part, TriangleTree(whole), 1e-3).upper, 1e-3);
  EXPECT_GT(one_sided_hausdorff(whole, TriangleTree(part), 1e-3).lower, 0.2);
}

TEST(Hausdorff, SeesABumpBetweenVertices) {
  // The farthest points of an octahedron's flat sides lie in their middle, not at its vertices.
  const SurfaceMesh coarse = testing::icosphere(0), fine = testing::icosphere(5);
  const double inradius = std::sqrt((5 + 2 * std::sqrt(5)) / 15);
  const HausdorffBounds d = hausdorff_distance(coarse, fine, 1e-3);
  EXPECT_NEAR(d.upper, 1 - inradius, 3e-3);
  EXPECT_NEAR(d.lower, 1 - inradius, 3e-3);
}

}  // namespace
}  // namespace octafront
