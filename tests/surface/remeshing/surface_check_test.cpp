#include "surface/remeshing/surface_check.h"

#include "support/named_surfaces.h"

#include <utility>

#include <gtest/gtest.h>

namespace octafront {
namespace {

TEST(SurfaceCheck, OtherTriangulationsOfTheSameKindPass) {
  EXPECT_EQ(first_surface_defect(testing::icosphere(2), testing::cube(3)), std::nullopt);
  EXPECT_EQ(first_surface_defect(testing::torus(20, 10), testing::torus(12, 8)), std::nullopt);
  EXPECT_EQ(first_surface_defect(testing::hollow_sphere(2), testing::hollow_sphere(1)), std::nullopt);
}

void expect_defect(const SurfaceMesh& result, const SurfaceMesh& input, const std::string& words) {
  const auto defect = first_surface_defect(result, input);
  ASSERT_TRUE(defect.has_value()) << words;
  EXPECT_NE(defect->find(words), std::string::npos) << *defect;
}

TEST(SurfaceCheck, FindsEachKindOfDefect) {
  const SurfaceMesh ball = testing::icosphere(2);
  SurfaceMesh s = ball;
  s.triangles.pop_back();
  expect_defect(s, ball, "1 hole (3 open edges)");
  s = ball;
  std::swap(s.triangles[7][0], s.triangles[7][1]);
  expect_defect(s, ball, "3 edges whose two faces");
  s = ball;
  s.points[3] = s.points[3] * -1.1;
  expect_defect(s, ball, "of faces that cut or touch");
  s = ball;
  s.points.push_back({1, 2, 3});
  expect_defect(s, ball, "no triangle uses vertex 162 at (1, 2, 3)");
  s = ball;
  s.triangles[0][0] = 5000;
  expect_defect(s, ball, "refers to vertex 5000");
}

TEST(SurfaceCheck, FindsAnotherTopology) {
  const SurfaceMesh ball = testing::icosphere(2);
  const SurfaceMesh two = testing::joined(ball, testing::transformed(ball, 1, {5, 0, 0}));
  expect_defect(testing::torus(12, 8), ball, "genus 1");
  expect_defect(two, ball, "2 shells instead of 1");
  expect_defect(testing::reversed(ball), ball, "inside out");
  expect_defect(testing::joined(ball, testing::transformed(ball, 0.5, {})), testing::hollow_sphere(2), "inside out");
  expect_defect(two, testing::hollow_sphere(2), "instead of");
}

TEST(SurfaceCheck, TellsWhichShellIsInsideOut) {
  const SurfaceMesh ball = testing::icosphere(2), small = testing::transformed(ball, 0.1, {5, 0, 0});
  const SurfaceMesh two = testing::joined(ball, small), wrong = testing::joined(ball, testing::reversed(small));
  const SurfaceKind kind(two, make_edge_table(two.points.size(), two.triangles));
  std::vector<Vec3> places;
  EXPECT_EQ(kind.first_defect_but_crossings(two, {}, &places), std::nullopt);
  EXPECT_TRUE(places.empty());
  EXPECT_NE(kind.first_defect_but_crossings(wrong, {}, &places), std::nullopt);
  EXPECT_EQ(places.size(), small.points.size());
  for (const Vec3 p : places) EXPECT_LT(distance(p, {5, 0, 0}), 0.2);
}

}  // namespace
}  // namespace octafront
