#include "base/geometry/triangle_tree.h"

#include "base/core/validate.h"
#include "base/geometry/measures.h"
#include "base/geometry/predicates.h"
#include "support/lattice_points.h"
#include "support/named_surfaces.h"

#include <algorithm>
#include <numbers>
#include <set>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace octafront {
namespace {

using Location = TriangleTree::Location;

Vec3 any_point() {
  return testing::lattice_point(48, 1.0 / 32);
}

SurfaceMesh any_soup(int triangles, int range) {
  SurfaceMesh s;
  for (int i = 0; i < 3 * triangles; ++i) s.points.push_back(testing::lattice_point(range));
  for (VertexIndex v = 0; v < s.points.size(); v += 3) s.triangles.push_back({v, v + 1, v + 2});
  return s;
}

TriangleCorners tree_corners_of(const SurfaceMesh& s, const Triangle& t) {
  return {s.points[t[0]], s.points[t[1]], s.points[t[2]]};
}

TEST(TriangleTree, OfNothingAnswersNothing) {
  const TriangleTree tree{SurfaceMesh{}};
  EXPECT_TRUE(tree.empty());
  EXPECT_EQ(tree.nearest({1, 2, 3}).triangle, kNone);
  EXPECT_EQ(tree.first_hit({0, 0, 0}, {1, 0, 0}).triangle, kNone);
  EXPECT_EQ(tree.locate({0, 0, 0}), Location::kOutside);
  tree.for_each_overlapping({{0, 0, 0}, {1, 1, 1}}, [](std::uint32_t) { FAIL(); });
}

RC_GTEST_PROP(TriangleTree, HoldsEachTriangleInBoxesThatFit, ()) {
  RC_ASSERT(!TriangleTree(any_soup(*rc::gen::inRange(0, 300), 8)).first_inconsistency());
}

TEST(TriangleTree, SaysWhereATriangleLeavesItsBox) {
  SurfaceMesh s = testing::unit_tetrahedron();
  s.points[3].x = std::numeric_limits<double>::quiet_NaN();
  if (kValidate) {
    EXPECT_THROW(TriangleTree{s}, std::logic_error);
  } else {
    const std::string wrong = TriangleTree(s).first_inconsistency().value_or("");
    EXPECT_NE(wrong.find("leaves the box of its leaf"), std::string::npos) << wrong;
  }
}

RC_GTEST_PROP(TriangleTree, NearestIsTheNearestOfAll, ()) {
  const SurfaceMesh s = any_soup(*rc::gen::resize(100, rc::gen::inRange(1, 60)), 8);
  const TriangleTree tree(s);
  for (int i = 0; i < 10; ++i) {
    const Vec3 p = testing::lattice_point(12);
    double least = TriangleTree::kFar;
    for (const Triangle& t : s.triangles) {
      const auto c = tree_corners_of(s, t);
      least = std::min(least, squared_distance(p, closest_point_on_triangle(p, c[0], c[1], c[2])));
    }
    const auto found = tree.nearest(p);
    RC_ASSERT(found.squared_distance == least);
    RC_ASSERT(squared_distance(found.point, p) == least);
    const auto c = tree.corners(found.triangle);
    RC_ASSERT(c == tree_corners_of(s, s.triangles[found.triangle]));
    RC_ASSERT(closest_point_on_triangle(p, c[0], c[1], c[2]) == found.point);
    RC_ASSERT(tree.nearest(p, least).triangle == kNone);
  }
}

RC_GTEST_PROP(TriangleTree, WithinADistanceIsWhatTheNearestSays, ()) {
  const TriangleTree tree(any_soup(*rc::gen::inRange(1, 100), 24));
  const Vec3 p = any_point();
  const double nearest = std::sqrt(tree.nearest(p).squared_distance);
  RC_ASSERT(tree.is_within(p, nearest * 1.01 + 1e-9));
  RC_ASSERT(!tree.is_within(p, nearest * 0.99));
  RC_ASSERT(!tree.is_within(p, -1));
}

RC_GTEST_PROP(TriangleTree, BoxQueryFindsEveryTriangleWithAPointInside, ()) {
  const SurfaceMesh s = any_soup(40, 8);
  const TriangleTree tree(s);
  Box3 box;
  box.add(testing::lattice_point(8));
  box.add(testing::lattice_point(8));
  std::set<std::uint32_t> found;
  tree.for_each_overlapping(box, [&](std::uint32_t t) { RC_ASSERT(found.insert(t).second); });
  constexpr int kSteps = 10;
  for (std::uint32_t t = 0; t < s.triangles.size(); ++t) {
    const auto [a, b, c] = tree_corners_of(s, s.triangles[t]);
    bool inside = false;
    for (int i = 0; i <= kSteps; ++i)
      for (int j = 0; i + j <= kSteps; ++j)
        inside = inside || box.contains((a * i + b * j + c * (kSteps - i - j)) / kSteps);
    if (inside) RC_ASSERT(found.count(t) == 1);
    if (!box_of({a, b, c}).overlaps(box)) RC_ASSERT(found.count(t) == 0);
  }
}

TEST(TriangleOverlapsBox, IsTighterThanItsBox) {
  const Box3 unit{{0, 0, 0}, {1, 1, 1}};
  EXPECT_FALSE(triangle_overlaps_box({{{3.1, 0, 0}, {0, 3.1, 0}, {0, 0, 3.1}}}, unit));
  EXPECT_TRUE(triangle_overlaps_box({{{3, 0, 0}, {0, 3, 0}, {0, 0, 3}}}, unit));
  EXPECT_FALSE(triangle_overlaps_box({{{1.2, 0.9, 0.5}, {0.9, 1.2, 0.5}, {2, 2, 0.5}}}, unit));
  EXPECT_TRUE(triangle_overlaps_box({{{0.5, 0.5, -9}, {0.5, 0.5, 9}, {9, 9, 0}}}, unit));
}

RC_GTEST_PROP(TriangleTree, SegmentHitsAreThoseOfEachTriangle, ()) {
  SurfaceMesh s = any_soup(40, 6);
  std::erase_if(s.triangles,
                [&](const Triangle& t) { return collinear(s.points[t[0]], s.points[t[1]], s.points[t[2]]); });
  const TriangleTree tree(s);
  const Vec3 p = testing::lattice_point(8), q = testing::lattice_point(8);
  std::set<std::uint32_t> found;
  tree.for_each_hit(p, q, [&](std::uint32_t t, const SegmentHit&) { found.insert(t); });
  for (std::uint32_t t = 0; t < s.triangles.size(); ++t)
    RC_ASSERT((found.count(t) == 1) ==
              static_cast<bool>(segment_triangle_hit(p, q, tree_corners_of(s, s.triangles[t]))));
}

TEST(FirstHit, EntersASphereAtItsRadiusThroughEdgesAndVerticesToo) {
  const SurfaceMesh sphere = testing::icosphere(3);
  const TriangleTree tree(sphere);
  for (const Triangle& t : sphere.triangles) {
    const auto [a, b, c] = tree_corners_of(sphere, t);
    for (const Vec3 target : {a, (a + b) * 0.5, centroid(a, b, c)}) {
      const auto in = tree.first_hit(target * 3, target * -1);
      ASSERT_NE(in.triangle, kNone);
      EXPECT_NEAR(in.t, 2, 1e-12);
      const auto out = tree.first_hit({0, 0, 0}, target);
      ASSERT_NE(out.triangle, kNone);
      EXPECT_NEAR(out.t, 1, 1e-12);
    }
  }
  EXPECT_EQ(tree.first_hit({3, 0, 0}, {-1, 0, 0}, 1.5).triangle, kNone);
  EXPECT_EQ(tree.first_hit({3, 0, 0}, {1, 0, 0}).triangle, kNone);
}

TEST(FirstHit, RunsAlongSidesOfBoxes) {
  const TriangleTree tree(testing::cube(2));
  for (const double y : {0.0, 0.25, 0.5, 1.0}) {
    EXPECT_EQ(tree.first_hit({-1, y, 1}, {1, 0, 0}).t, 1) << y;
    EXPECT_EQ(tree.first_hit({2, y, 0}, {-1, 0, 0}).t, 1) << y;
  }
}

RC_GTEST_PROP(Locate, KnowsTheCubeExactly, ()) {
  const int n = *rc::gen::inRange(1, 5);
  const TriangleTree tree(testing::transformed(testing::cube(n), 32, {}));
  for (int i = 0; i < 20; ++i) {
    const Vec3 p = testing::lattice_point(20, 2);
    const double least = std::min({p.x, p.y, p.z, 32 - p.x, 32 - p.y, 32 - p.z});
    const Location expected = least > 0 ? Location::kInside : least < 0 ? Location::kOutside : Location::kOnSurface;
    RC_ASSERT(tree.locate(p) == expected);
    RC_ASSERT(tree.contains(p) == (least > 0));
  }
}

TEST(Locate, SeesOneUlp) {
  const TriangleTree tree(testing::cube(3));
  for (const double y : {1.0 / 3, 0.4, 2.0 / 3}) {
    EXPECT_EQ(tree.locate({std::nextafter(1.0, 2.0), y, y}), Location::kOutside);
    EXPECT_EQ(tree.locate({1, y, y}), Location::kOnSurface);
    EXPECT_EQ(tree.locate({std::nextafter(1.0, 0.0), y, y}), Location::kInside);
  }
}

TEST(Locate, KnowsCavitiesAndHoles) {
  const TriangleTree hollow(testing::hollow_sphere(3));
  EXPECT_EQ(hollow.locate({0, 0, 0}), Location::kOutside);
  EXPECT_EQ(hollow.winding_number({0, 0, 0}), 0);
  EXPECT_EQ(hollow.locate({0, 0, 0.75}), Location::kInside);
  EXPECT_EQ(hollow.winding_number({0, 0, -0.75}), 1);
  const TriangleTree torus(testing::torus(24, 12));
  EXPECT_EQ(torus.locate({0, 0, 0}), Location::kOutside);
  EXPECT_EQ(torus.locate({1, 0, 0}), Location::kInside);
}

TEST(Locate, CountsWindingsOfOverlappingShells) {
  const SurfaceMesh sphere = testing::icosphere(2);
  const TriangleTree twice(testing::joined(sphere, testing::transformed(sphere, 2, {0, 0, 0.25})));
  EXPECT_EQ(twice.winding_number({0, 0, 0}), 2);
  EXPECT_EQ(twice.winding_number({0, 0, 1.5}), 1);
  EXPECT_EQ(twice.winding_number({0, 0, -1.5}), 1);
  EXPECT_EQ(TriangleTree(testing::reversed(sphere)).winding_number({0.1, 0, 0.2}), -1);
}

RC_GTEST_PROP(Locate, AgreesWithTheSphere, ()) {
  static const TriangleTree tree(testing::icosphere(4));
  const Vec3 p = any_point();
  // The facets lie at most 1 - cos(half an edge's angle) below the sphere.
  if (length(p) > 1) RC_ASSERT(tree.locate(p) == Location::kOutside);
  if (length(p) < 0.995) RC_ASSERT(tree.winding_number(p) == 1);
}

}  // namespace
}  // namespace octafront
