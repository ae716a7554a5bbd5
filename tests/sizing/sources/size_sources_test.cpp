#include <octafront/error.h>

#include "sizing/field/octree_field.h"
#include "sizing/size_cases.h"
#include "sizing/sources/make_size_field.h"
#include "sizing/sources/surface_samples.h"
#include "support/labelled_walls.h"
#include "support/named_surfaces.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using testing::box;
using testing::cube;
using testing::each;
using testing::icosphere;
using testing::sizes_of;
using testing::torus;
using testing::transformed;

TEST(SizeField, ACallbackIsAskedInBatches) {
  std::size_t points = 0, batches = 0;
  SizeOptions o;
  o.callback = [&](std::span<const Vec3> at, std::span<double> sizes) {
    points += at.size();
    ++batches;
    std::fill(sizes.begin(), sizes.end(), 0.05);
  };
  sizes_of(cube(1), o);
  EXPECT_GT(points, 1000u);
  EXPECT_LT(batches, points / 20);
}

TEST(SizeField, StripsSideBySideAreNotSampledOneByOne) {
  constexpr VertexIndex kStrips = 20'000;
  SurfaceMesh ribbon;
  for (VertexIndex k = 0; k <= kStrips; ++k)
    for (const double y : {0.0, 1.0}) ribbon.points.push_back({static_cast<double>(k) / kStrips, y, 0});
  for (VertexIndex a = 0; a < 2 * kStrips; a += 2) {
    ribbon.triangles.push_back({a, a + 2, a + 3});
    ribbon.triangles.push_back({a, a + 3, a + 1});
  }
  const double h = 0.01;
  const auto samples = sample_surface(ribbon, std::vector<double>(ribbon.triangles.size(), h), {}, RunContext{});
  EXPECT_LT(samples.size(), 10 * ribbon.triangles.size());
  std::mt19937 random(1);
  std::uniform_real_distribution<double> in(0, 1);
  for (int i = 0; i < 100; ++i) {
    const Vec3 p{in(random), in(random), 0};
    EXPECT_TRUE(
        std::ranges::any_of(samples, [&](const SizeSample& s) { return s.h == h && distance(s.p, p) <= s.reach; }));
  }
}

TEST(SizeField, KeepsWithinItsLimits) {
  SizeOptions o;
  o.min_size = 0.05;
  o.max_size = 0.09;
  o.curvature = 30;
  const SizeField h = sizes_of(torus(60, 24), o);
  EXPECT_GE(h.min_size(), 0.05 * (1 - 1e-9));
  EXPECT_LE(h.max_size(), 0.09 * (1 + 1e-9));
}

TEST(SizeField, UniformSizeIsThatSizeEverywhere) {
  SizeOptions o;
  o.size = 0.07;
  const SizeField h = sizes_of(icosphere(3), o);
  EXPECT_DOUBLE_EQ(h.min_size(), 0.07);
  EXPECT_DOUBLE_EQ(h.max_size(), 0.07);
  EXPECT_LT(as_octree_field(h)->tree.size(), 20000u);
}

TEST(SizeField, CurvatureOfASphereGivesElementsPerTurn) {
  SizeOptions o;
  o.curvature = 24;
  o.max_size = 10;
  const SurfaceMesh sphere = icosphere(5);
  const SizeField h = sizes_of(sphere, o);
  for (const Vec3 p : sphere.points) ASSERT_NEAR(h.at(p), 2 * M_PI / 24, 0.05 * 2 * M_PI / 24);
}

TEST(SizeField, CurvatureAsksForTheSameHoweverTheTrianglesAreNumbered) {
  SizeOptions o;
  o.curvature = 24;
  o.max_size = 10;
  SurfaceMesh surface = torus(60, 25, 1, 0.3);
  const SizeField h = sizes_of(surface, o);
  std::shuffle(surface.triangles.begin(), surface.triangles.end(), std::mt19937(7));
  const SizeField other = sizes_of(surface, o);
  for (const Vec3 p : surface.points) ASSERT_NEAR(h.at(p), other.at(p), 1e-9);
}

TEST(SizeField, ThinWallsAndNarrowGapsGetElementsAcross) {
  SizeOptions o;
  o.gap = 2;
  o.max_size = 0.4;
  const SurfaceMesh plate = box(2, 2, 0.1, 1);
  const SizeField wall = sizes_of(plate, o);
  for (const Vec3 p : {Vec3{1, 1, 0.1}, Vec3{0.3, 1.7, 0}, Vec3{1.9, 0.1, 0.1}}) EXPECT_NEAR(wall.at(p), 0.05, 0.005);
  const SurfaceMesh two = testing::joined(box(2, 2, 1, 1), transformed(box(2, 2, 1, 1), 1, {0, 0, 1.2}));
  const SizeField gap = sizes_of(two, o);
  EXPECT_NEAR(gap.at({1, 1, 1}), 0.1, 0.01);
  EXPECT_NEAR(gap.at({0.5, 1.2, 1.2}), 0.1, 0.01);
  EXPECT_GT(gap.at({1, 1, 0}), 0.18);
}

TEST(SizeField, AutomaticSizesSeeWallsButNoGapsBetweenThem) {
  const SurfaceMesh apart = testing::joined(box(2, 2, 1, 1), transformed(box(2, 2, 1, 1), 1, {0, 0, 1.05}));
  const SizeField gap = sizes_of(apart, {});
  EXPECT_EQ(gap.at({1, 1, 1}), gap.max_size());
  const SizeField wall = sizes_of(box(2, 2, 0.05, 1), {});
  EXPECT_NEAR(wall.at({1, 1, 0.05}), 0.05, 0.01);
}

TEST(SizeField, ARegionHasSizesByItsThickness) {
  // A box 2 thick under one that is 10 thick: faces of the thin one ask for half of 2, of the thick one for 4 at most.
  testing::GridPlanes planes{{}, {}, {0, 2, 12}};
  for (int i = 0; i <= 20; ++i) planes.x.push_back(i), planes.y.push_back(i);
  SurfaceMesh two = testing::box_walls(planes, [](Vec3 middle) { return middle.z < 2 ? 0u : 1u; });
  two.region_names = {"thin", "thick"};
  SizeOptions o;
  o.size = 30;
  o.gradation = .5;
  o.named = {{"thin", .5, .5, 5}, {"thick", .5, .5, 4}};
  const SizeField field = sizes_of(two, o);
  EXPECT_NEAR(field.at({10, 10, 0}), 1, .3);
  EXPECT_NEAR(field.at({10, 10, 12}), 4, .5);
  EXPECT_LE(field.at({10, 10, 7}), 4.01);
  o.named[0].most = .7;
  EXPECT_NEAR(sizes_of(two, o).at({10, 10, 0}), .7, .2);
  o.named = {{"box:0,0,0,1,1,1", .5, .5, 5}};
  EXPECT_THROW(sizes_of(two, o), OptionError);
  o.named = {{"thin", 2, .5, 1}};
  EXPECT_THROW(sizes_of(two, o), OptionError);
}

TEST(SizeField, EdgesAreNoGaps) {
  SizeOptions o;
  o.gap = 3;
  o.max_size = 0.1;
  EXPECT_DOUBLE_EQ(sizes_of(cube(4), o).min_size(), 0.1);
}

TEST(SizeField, FacetsOfTheInputSetTheSizeByThePapersRule) {
  SizeOptions o;
  o.facets = true;
  o.max_size = 1;
  const SizeField h = sizes_of(cube(10), o);  // triangles of area 1 / 200
  EXPECT_NEAR(h.at({1, 0.4, 0.6}), std::sqrt(1.0 / 200), 1e-3);
}

TEST(SizeField, FeatureCurvesGetTheirElements) {
  Features features;  // one edge of the cube, as a curve of length 1
  const SurfaceMesh surface = cube(4);
  for (VertexIndex a = 0; a < surface.points.size(); ++a) {
    for (VertexIndex b = a + 1; b < surface.points.size(); ++b) {
      const Vec3 p = surface.points[a], q = surface.points[b];
      if (p.y == 0 && p.z == 0 && q.y == 0 && q.z == 0 && distance(p, q) < 0.3) features.edges.push_back({a, b});
    }
  }
  ASSERT_EQ(features.edges.size(), 4u);
  SizeOptions o;
  o.feature_elements = 10;
  o.max_size = 1;
  o.gradation = 0.12;
  const SizeField h = sizes_of(surface, o, features);
  EXPECT_NEAR(h.at({0.5, 0, 0}), 0.1, 0.01);
  EXPECT_NEAR(h.at({0.5, 1, 0}), 0.22, 0.02);
}

// The automatic size has no say where a function speaks for the whole surface, nor does any size between its samples.
TEST(SizeField, ACallbackAloneIsNotCapped) {
  SizeOptions o;
  o.callback = each([](Vec3) { return 0.3; });
  const SizeField even = sizes_of(cube(1), o);
  EXPECT_NEAR(even.min_size(), 0.3, 1e-3);
  EXPECT_NEAR(even.max_size(), 0.3, 1e-3);
  o.callback = each([](Vec3 p) { return 0.1 + length(p - Vec3{1, 1, 1}); });
  o.gradation = 1;
  const SizeField far = sizes_of(cube(1), o);
  EXPECT_NEAR(far.at({1, 1, 1}), 0.1, 0.08);
  EXPECT_GT(far.at({0, 0, 0}), 1);
  // Small in one corner of large faces that are large at their middle.
  o.callback = each([](Vec3 p) { return length(p - Vec3{1, 1, 1}) < 0.15 ? 0.02 : 5.0; });
  EXPECT_LT(sizes_of(cube(1), o).at({1, 1, 1}), 0.03);
  o.max_size = 0.2;
  EXPECT_LE(sizes_of(cube(1), o).max_size(), 0.2);
}

std::vector<std::string> notes_on(const SizeOptions& options) {
  StageReport report;
  const RunContext context;
  note_misplaced_sizes(cube(2), options, Stage(context, report));
  return report.notes;
}

TEST(MisplacedSizes, AreSaid) {
  SizeOptions inside;
  inside.regions = {{{0.5, 0.5, 0.5}, {0.5, 0.5, 0.5}, 0.1, 0.1}, {{-1, -1, -1}, {9, 9, 0.1}, 0, 0.2}};
  inside.point_sizes = {{{0, 0, 0}, 0.1}, {{1.05, 1, 1}, 0.2}};
  inside.field = SizeField::uniform(0.1);
  EXPECT_TRUE(notes_on(inside).empty());
  SizeOptions outside = inside;
  outside.regions.push_back({{50, 50, 50}, {50, 50, 50}, 1, 0.05});
  ASSERT_EQ(notes_on(outside).size(), 1U);
  EXPECT_NE(notes_on(outside)[0].find("1 of 3 regions in `regions` lies outside"), std::string::npos)
      << notes_on(outside)[0];
  outside.regions.clear();
  outside.point_sizes.push_back({{50, 50, 50}, 0.02});
  ASSERT_EQ(notes_on(outside).size(), 1U);
  EXPECT_NE(notes_on(outside)[0].find("1 of 3 points in `point_sizes` lies outside"), std::string::npos);
}

TEST(MisplacedSizes, AFieldCoversTheModel) {
  SizeOptions o;
  o.size = 0.2;
  SizeOptions with_field;
  with_field.field = sizes_of(cube(2), o);
  EXPECT_TRUE(notes_on(with_field).empty());
  with_field.field = sizes_of(transformed(cube(2), 1, {0.5, 0, 0}), o);
  ASSERT_EQ(notes_on(with_field).size(), 1U);
  EXPECT_NE(notes_on(with_field)[0].find("% of the surface's vertices lie outside"), std::string::npos);
  with_field.field = sizes_of(transformed(cube(2), 1, {10, 0, 0}), o);
  EXPECT_THROW(notes_on(with_field), OptionError);
}

TEST(SizeField, InteriorStaysBelowTheSurfaceUnlessGraded) {
  SizeOptions o;
  o.callback = each([](Vec3 p) { return 0.05 + 0.05 * std::abs(p.x); });
  o.max_size = 1;
  const SurfaceMesh sphere = icosphere(4);
  const SizeField uniform = sizes_of(sphere, o);
  EXPECT_LE(uniform.max_size(), 0.1 * 1.02);
  o.interior = SizeOptions::Interior::kGraded;
  const SizeField graded = sizes_of(sphere, o);
  EXPECT_GT(graded.at({0, 0, 0}), 0.13);
  EXPECT_NEAR(graded.at({1, 0, 0}), 0.1, 0.01);
}

TEST(KeptSurface, SizesAreThoseOfItsTriangles) {
  const SurfaceMesh sphere = icosphere(4);
  StageReport report;
  const SizeField h = size_field_of_surface(KnownSurface(sphere, Features{}), {}, {RunContext{}, report});
  const Triangle t = sphere.triangles[7];
  EXPECT_NEAR(h.at(sphere.points[t[0]]), distance(sphere.points[t[0]], sphere.points[t[1]]), 0.15 * h.min_size());
}

TEST(SizeOptions, ContradictionsAreRefused) {
  const auto refused = [](auto&& change) {
    SizeOptions o;
    change(o);
    EXPECT_THROW(sizes_of(cube(), o), OptionError);
  };
  refused([](SizeOptions& o) { o.size = 0; });
  refused([](SizeOptions& o) { o.size = -1; });
  refused([](SizeOptions& o) { o.size = std::nan(""); });
  refused([](SizeOptions& o) { o.size = 1, o.elements = 5; });
  refused([](SizeOptions& o) { o.elements = 0; });
  refused([](SizeOptions& o) { o.min_size = 2, o.max_size = 1; });
  refused([](SizeOptions& o) { o.size = 1, o.min_size = 2; });
  refused([](SizeOptions& o) { o.gradation = 0; });
  refused([](SizeOptions& o) { o.gradation = 1.5; });
  refused([](SizeOptions& o) { o.curvature = 2; });
  refused([](SizeOptions& o) { o.size = 1e-5; });
  refused([](SizeOptions& o) { o.callback = each([](Vec3) { return -1.0; }); });
}

}  // namespace
}  // namespace octafront
