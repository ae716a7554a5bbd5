#include "soup/coarse/decimate.h"

#include <octafront/no_context.h>
#include <octafront/repair.h>

#include "base/mesh/complex.h"
#include "support/labelled_walls.h"
#include "support/named_surfaces.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using testing::box_walls;
using testing::even_planes;

std::string words_of_defects(const SurfaceMesh& surface) {
  return find_defects(repair_surface(surface)).describe();
}

double longest_edge(const SurfaceMesh& s) {
  double longest = 0;
  for (const Triangle& t : s.triangles)
    for (int i = 0; i < 3; ++i) longest = std::max(longest, distance(s.points[t[i]], s.points[t[(i + 1) % 3]]));
  return longest;
}

/// Cells of some points in the unit cube, of cubes of a 32nd; each face of the cube is a patch.
SurfaceMesh stairs() {
  constexpr int kPlanes = 33;
  SurfaceMesh s =
      box_walls({even_planes(kPlanes), even_planes(kPlanes), even_planes(kPlanes)}, testing::nearest_of(12, 5));
  for (const Triangle& t : s.triangles) {
    std::uint32_t patch = 0;
    for (int axis = 0; axis < 3; ++axis)
      for (int side = 0; side < 2; ++side)
        if (std::ranges::all_of(t, [&](VertexIndex v) { return s.points[v][axis] == side; }))
          patch = 1 + 2 * static_cast<std::uint32_t>(axis) + static_cast<std::uint32_t>(side);
    s.patch.push_back(patch);
  }
  return s;
}

/// Two layers that wave, one of them a hundredth thick, of squares of a 40th.
SurfaceMesh waves() {
  constexpr int kPlanes = 41;
  const auto layer = [](Vec3 p) -> std::uint32_t { return p.z > 0.5 && p.z < 0.51 ? 1 : 0; };
  return testing::mapped(box_walls({even_planes(kPlanes), even_planes(kPlanes), {0, 0.5, 0.51, 1}}, layer), [](Vec3 p) {
    return p + Vec3{0, 0, 0.08 * std::sin(12 * p.x) * std::sin(11 * p.y)};
  });
}

TEST(Decimate, ABallStaysRound) {
  const SurfaceMesh ball = testing::icosphere(5);
  const SurfaceMesh made = decimated(ball, {.edge = 0.3, .deviation = 0.01}, no_context());
  EXPECT_EQ(words_of_defects(made), "");
  EXPECT_LT(10 * made.triangles.size(), ball.triangles.size());
  EXPECT_LE(longest_edge(made), 0.3);
  EXPECT_NEAR(enclosed_volume(made), enclosed_volume(ball), 0.01 * enclosed_volume(ball));
}

TEST(Decimate, RegionsKeepTheirPlacesAndFlatPatchesStayFlat) {
  const SurfaceMesh before = stairs();
  const SurfaceMesh made = decimated(before, {.edge = 0.15, .deviation = 0.01, .sharp_angle = 120}, no_context());
  EXPECT_EQ(words_of_defects(made), "");
  EXPECT_LT(2 * made.triangles.size(), before.triangles.size());
  ASSERT_EQ(region_count(made), region_count(before));
  const std::vector<double> was = volumes_of_regions(before), is = volumes_of_regions(made);
  for (std::size_t r = 0; r < was.size(); ++r) EXPECT_NEAR(is[r], was[r], 0.03 * was[r]) << r;
  for (std::size_t t = 0; t < made.triangles.size(); ++t) {
    if (made.patch[t] == 0) continue;
    const std::uint32_t face = made.patch[t] - 1;
    for (const VertexIndex v : made.triangles[t]) EXPECT_EQ(made.points[v][face / 2], face % 2);
  }
}

TEST(Decimate, ThinLayersDoNotCross) {
  const SurfaceMesh before = waves();
  const SurfaceMesh made = decimated(before, {.edge = 0.25, .deviation = 0.03, .sharp_angle = 60}, no_context());
  EXPECT_EQ(words_of_defects(made), "");
  EXPECT_LT(made.triangles.size(), before.triangles.size());
}

TEST(Decimate, WhatIsSmallIsNotMadeFlat) {
  const SurfaceMesh made = decimated(testing::icosphere(1), {.edge = 10, .deviation = 10}, no_context());
  EXPECT_EQ(made.triangles.size(), 20u);
  EXPECT_GT(enclosed_volume(made), 1);
}

TEST(Decimate, IsTheSameForAnyNumberOfThreads) {
  const SurfaceMesh before = testing::icosphere(7);
  const DecimationLimits limits{.edge = 0.1, .deviation = 0.001};
  RunContext one, many;
  one.threads = 1, many.threads = 7;
  EXPECT_EQ(decimated(before, limits, one), decimated(before, limits, many));
}

}  // namespace
}  // namespace octafront
