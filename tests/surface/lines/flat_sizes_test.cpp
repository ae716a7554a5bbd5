
#include "support/named_surfaces.h"
#include "surface/lines/line_sizes.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace octafront::surface {
namespace {

using testing::icosphere;

InputSurface input_of(const SurfaceMesh& surface) {
  return make_input_surface(surface, make_edge_table(surface.points.size(), surface.triangles));
}

TEST(FlatSizes, NothingIsAskedForOnFlatSides) {
  const InputSurface cube = input_of(testing::cube(8));
  const std::vector<PointSize> places = sizes_by_flatness(cube, {}, SizeField::uniform(0.05), 0.01, {});
  for (const PointSize& place : places) {
    const auto from_side = [](double x) { return std::min(x, 1 - x); };
    const double x = from_side(place.p.x), y = from_side(place.p.y), z = from_side(place.p.z);
    EXPECT_LT(x + y + z - std::max({x, y, z}), 0.05);  // beside an edge of the cube
  }
}

TEST(FlatSizes, FallWithTheSquareRootOfTheToleranceOnASphere) {
  const InputSurface sphere = input_of(icosphere(5));
  double before = 0;
  for (const double tolerance : {0.005, 0.02}) {
    const std::vector<PointSize> places = sizes_by_flatness(sphere, {}, SizeField::uniform(1), tolerance, {});
    ASSERT_FALSE(places.empty());
    double least = HUGE_VAL, most = 0;
    for (const PointSize& place : places) {
      least = std::min(least, place.size);
      most = std::max(most, place.size);
    }
    EXPECT_LT(most, 1.3 * least);  // the same all over
    // A triangle of this size cuts off about as much: the edge h lies h^2 / 8 below, the middle h^2 / 6.
    EXPECT_LT(most * most / 8, 2.5 * tolerance);
    EXPECT_GT(most * most / 6, 0.5 * tolerance);
    if (before > 0) {
      EXPECT_NEAR(most / before, 2, 0.3);
    }
    before = most;
  }
}

TEST(FlatSizes, AreNoFinerThanTheInput) {
  const InputSurface sphere = input_of(icosphere(2));
  for (const PointSize& place : sizes_by_flatness(sphere, {}, SizeField::uniform(1), 1e-6, {}))
    EXPECT_GT(place.size, 0.2);  // its edges measure .28 to .32
}

TEST(FlatSizes, FollowACurve) {
  // A polygon of many corners, on the edges of a cone's base.
  constexpr int kCorners = 200;
  constexpr double kTolerance = 0.01;
  SurfaceMesh cone;
  cone.points = {{0, 0, 1}, {0, 0, 0}};
  for (int i = 0; i < kCorners; ++i) {
    const double a = 2 * std::numbers::pi * i / kCorners;
    cone.points.push_back({std::cos(a), std::sin(a), 0});
  }
  Curve rim;
  rim.closed = true;
  for (std::uint32_t i = 0; i < kCorners; ++i) {
    const std::uint32_t a = 2 + i, b = 2 + (i + 1) % kCorners;
    rim.half_edges.push_back(static_cast<HalfEdge>(3 * cone.triangles.size()));
    cone.triangles.push_back({a, b, 0});
    cone.triangles.push_back({b, a, 1});
  }
  const InputSurface input = input_of(cone);
  const SizeField wanted = SizeField::uniform(1);
  const std::vector<PointSize> places = sizes_by_flatness(input, {rim}, wanted, kTolerance, {});
  const double chord = std::sqrt(8 * kTolerance);  // what it cuts off measures its square over 8
  bool found = false;
  for (const PointSize& place : places)
    found = found || (place.p.z == 0 && place.size > 0.8 * chord && place.size < 1.01 * chord);
  EXPECT_TRUE(found);
}

TEST(Thinned, TheSmallestOfNearPlacesStays) {
  const std::vector<PointSize> kept = smallest_ones({{{0, 0, 0}, 1.0}, {{0.1, 0, 0}, 0.5}, {{5, 0, 0}, 1.0}});
  ASSERT_EQ(kept.size(), 2u);
  EXPECT_EQ(kept[0].size, 0.5);
  EXPECT_EQ(kept[1].p, (Vec3{5, 0, 0}));
  EXPECT_TRUE(smallest_ones({}).empty());
}

}  // namespace
}  // namespace octafront::surface
