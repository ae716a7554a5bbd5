#include <octafront/error.h>
#include <octafront/size_field.h>

#include "sizing/budget.h"
#include "sizing/change_size_field.h"
#include "sizing/check_size_options.h"
#include "sizing/curvature.h"
#include "sizing/expected_tets.h"
#include "sizing/kept_surface.h"
#include "sizing/make_size_field.h"
#include "sizing/octree_field.h"
#include "sizing/packed_sizes.h"
#include "sizing/tets_per_size.h"
#include "support/named_surfaces.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using testing::box;
using testing::cube;
using testing::icosphere;
using testing::torus;
using testing::transformed;

SizeField make(const SurfaceMesh& surface, const SizeOptions& options, const Features& features = {}) {
  StageReport report;
  return make_size_field(KnownSurface(surface, features), options, {RunContext{}, report});
}

/// A callback that looks at one point after the other.
auto each(double (*size_at)(Vec3)) {
  return [size_at](std::span<const Vec3> points, std::span<double> sizes) {
    std::transform(points.begin(), points.end(), sizes.begin(), size_at);
  };
}

/// Fields of many kinds on one surface each.
struct Case {
  std::string name;
  SurfaceMesh surface;
  SizeOptions options;
};

std::vector<Case> cases() {
  std::vector<Case> list;
  list.push_back({"automatic sphere", icosphere(3), {}});
  list.push_back({"automatic torus", torus(60, 24), {}});
  SizeOptions o;
  o.size = 0.1;
  list.push_back({"uniform cube", cube(3), o});
  o.interior = SizeOptions::Interior::kGraded;
  o.max_size = 0.5;
  list.push_back({"graded cube", cube(3), o});
  o = {};
  o.curvature = 40;
  o.gradation = 0.4;
  list.push_back({"curved torus", torus(60, 24, 1, 0.1), o});
  o = {};
  o.callback = each([](Vec3 p) { return 0.02 + 0.5 * length(p - Vec3{1, 0, 0}); });
  o.gradation = 0.15;
  list.push_back({"callback", icosphere(3), o});
  o.interior = SizeOptions::Interior::kGraded;
  list.push_back({"graded callback", icosphere(3), o});
  return list;
}

Vec3 random_point(std::mt19937& random, const Box3& box) {
  std::uniform_real_distribution<double> u(-0.1, 1.1);
  const Vec3 e = box.extent();
  return {box.lo.x + u(random) * e.x, box.lo.y + u(random) * e.y, box.lo.z + u(random) * e.z};
}

TEST(SizeField, ACallbackIsAskedInBatches) {
  std::size_t points = 0, batches = 0;
  SizeOptions o;
  o.callback = [&](std::span<const Vec3> at, std::span<double> sizes) {
    points += at.size();
    ++batches;
    std::fill(sizes.begin(), sizes.end(), 0.05);
  };
  make(cube(1), o);
  EXPECT_GT(points, 1000u);
  EXPECT_LT(batches, points / 20);
}

TEST(SizeField, ObeysItsGradationBetweenAnyTwoPoints) {
  std::mt19937 random(1);
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const SizeField h = make(c.surface, c.options);
    const Box3 box = bounding_box(c.surface.points);
    std::uniform_real_distribution<double> exponent(-4, 0);
    for (int n = 0; n < 20000; ++n) {
      const Vec3 p = random_point(random, box);
      const Vec3 q = p + (random_point(random, box) - p) * std::pow(10, exponent(random));
      ASSERT_LE(std::abs(h.at(p) - h.at(q)), c.options.gradation * distance(p, q) * (1 + 1e-9) + 1e-14 * h.max_size());
    }
  }
}

TEST(SizeField, IsContinuousAcrossLeaves) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const SizeField field = make(c.surface, c.options);
    const OctreeField& grid = *as_octree_field(field);
    EXPECT_TRUE(grid.tree.is_balanced());
    std::mt19937 random(2);
    std::uniform_real_distribution<double> u(0, 1);
    for (std::size_t l = 0; l < grid.tree.size(); ++l) {
      const Vec3 lo = grid.root.corner_of(grid.tree.leaf(l));
      const double side = grid.root.side_of(grid.tree.leaf(l));
      Vec3 p = lo + side * Vec3{u(random), u(random), u(random)};
      const int axis = static_cast<int>(l % 3);
      p[axis] = lo[axis];
      Vec3 below = p;
      below[axis] -= 1e-12 * grid.root.side;
      ASSERT_NEAR(field.at(p), field.at(below), 1e-11 * grid.root.side);
    }
  }
}

TEST(SizeField, KeepsWithinItsLimits) {
  SizeOptions o;
  o.min_size = 0.05;
  o.max_size = 0.09;
  o.curvature = 30;
  const SizeField h = make(torus(60, 24), o);
  EXPECT_GE(h.min_size(), 0.05 * (1 - 1e-9));
  EXPECT_LE(h.max_size(), 0.09 * (1 + 1e-9));
}

TEST(SizeField, UniformSizeIsThatSizeEverywhere) {
  SizeOptions o;
  o.size = 0.07;
  const SizeField h = make(icosphere(3), o);
  EXPECT_DOUBLE_EQ(h.min_size(), 0.07);
  EXPECT_DOUBLE_EQ(h.max_size(), 0.07);
  EXPECT_LT(as_octree_field(h)->tree.size(), 20000u);
}

TEST(SizeField, CurvatureOfASphereGivesElementsPerTurn) {
  SizeOptions o;
  o.curvature = 24;
  o.max_size = 10;
  const SurfaceMesh sphere = icosphere(5);
  const SizeField h = make(sphere, o);
  for (const Vec3 p : sphere.points) ASSERT_NEAR(h.at(p), 2 * M_PI / 24, 0.05 * 2 * M_PI / 24);
}

TEST(SizeField, CurvatureAsksForTheSameHoweverTheTrianglesAreNumbered) {
  SizeOptions o;
  o.curvature = 24;
  o.max_size = 10;
  SurfaceMesh surface = torus(60, 25, 1, 0.3);
  const SizeField h = make(surface, o);
  std::shuffle(surface.triangles.begin(), surface.triangles.end(), std::mt19937(7));
  const SizeField other = make(surface, o);
  for (const Vec3 p : surface.points) ASSERT_NEAR(h.at(p), other.at(p), 1e-9);
}

TEST(SizeField, ThinWallsAndNarrowGapsGetElementsAcross) {
  SizeOptions o;
  o.gap = 2;
  o.max_size = 0.4;
  const SurfaceMesh plate = box(2, 2, 0.1, 1);
  const SizeField wall = make(plate, o);
  for (const Vec3 p : {Vec3{1, 1, 0.1}, Vec3{0.3, 1.7, 0}, Vec3{1.9, 0.1, 0.1}}) EXPECT_NEAR(wall.at(p), 0.05, 0.005);
  const SurfaceMesh two = testing::joined(box(2, 2, 1, 1), transformed(box(2, 2, 1, 1), 1, {0, 0, 1.2}));
  const SizeField gap = make(two, o);
  EXPECT_NEAR(gap.at({1, 1, 1}), 0.1, 0.01);
  EXPECT_NEAR(gap.at({0.5, 1.2, 1.2}), 0.1, 0.01);
  EXPECT_GT(gap.at({1, 1, 0}), 0.18);
}

/// Thinner than what the automatic size resolves, a plate gets wider elements and not more of them.
TEST(SizeField, AutomaticSizesFollowThePlateSmoothly) {
  constexpr double kStep = 0.65;  // of the thickness; the count of a plate with one layer falls with its square
  double before = 0;
  for (double thickness = 0.1; thickness > 1e-4; thickness *= kStep) {
    const SurfaceMesh plate = box(1, 1, thickness, 1);
    const double n = expected_tets(make(plate, {}, detect_features(plate, 40)), plate);
    EXPECT_LT(n, 450'000) << thickness;
    if (before > 0) {
      EXPECT_LT(std::abs(std::log(n / before)), 2.6 * std::log(1 / kStep)) << thickness;
    }
    before = n;
  }
  EXPECT_LT(before, 10'000);
}

TEST(SizeField, EdgesAreNoGaps) {
  SizeOptions o;
  o.gap = 3;
  o.max_size = 0.1;
  EXPECT_DOUBLE_EQ(make(cube(4), o).min_size(), 0.1);
}

TEST(SizeField, FacetsOfTheInputSetTheSizeByThePapersRule) {
  SizeOptions o;
  o.facets = true;
  o.max_size = 1;
  const SizeField h = make(cube(10), o);  // triangles of area 1 / 200
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
  const SizeField h = make(surface, o, features);
  EXPECT_NEAR(h.at({0.5, 0, 0}), 0.1, 0.01);
  EXPECT_NEAR(h.at({0.5, 1, 0}), 0.1 + o.gradation, 0.02);
}

// The automatic size has no say where a function speaks for the whole surface, nor does any size between its samples.
TEST(SizeField, ACallbackAloneIsNotCapped) {
  SizeOptions o;
  o.callback = each([](Vec3) { return 0.3; });
  const SizeField even = make(cube(1), o);
  EXPECT_NEAR(even.min_size(), 0.3, 1e-3);
  EXPECT_NEAR(even.max_size(), 0.3, 1e-3);
  o.callback = each([](Vec3 p) { return 0.1 + length(p - Vec3{1, 1, 1}); });
  o.gradation = 1;
  const SizeField far = make(cube(1), o);
  EXPECT_NEAR(far.at({1, 1, 1}), 0.1, 0.08);
  EXPECT_GT(far.at({0, 0, 0}), 1);
  // Small in one corner of large faces that are large at their middle.
  o.callback = each([](Vec3 p) { return length(p - Vec3{1, 1, 1}) < 0.15 ? 0.02 : 5.0; });
  EXPECT_LT(make(cube(1), o).at({1, 1, 1}), 0.03);
  o.max_size = 0.2;
  EXPECT_LE(make(cube(1), o).max_size(), 0.2);
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
  with_field.field = make(cube(2), o);
  EXPECT_TRUE(notes_on(with_field).empty());
  with_field.field = make(transformed(cube(2), 1, {0.5, 0, 0}), o);
  ASSERT_EQ(notes_on(with_field).size(), 1U);
  EXPECT_NE(notes_on(with_field)[0].find("% of the surface's vertices lie outside"), std::string::npos);
  with_field.field = make(transformed(cube(2), 1, {10, 0, 0}), o);
  EXPECT_THROW(notes_on(with_field), OptionError);
}

TEST(SizeField, InteriorStaysBelowTheSurfaceUnlessGraded) {
  SizeOptions o;
  o.callback = each([](Vec3 p) { return 0.05 + 0.05 * std::abs(p.x); });
  o.max_size = 1;
  const SurfaceMesh sphere = icosphere(4);
  const SizeField uniform = make(sphere, o);
  EXPECT_LE(uniform.max_size(), 0.1 * 1.02);
  o.interior = SizeOptions::Interior::kGraded;
  const SizeField graded = make(sphere, o);
  EXPECT_GT(graded.at({0, 0, 0}), 0.13);
  EXPECT_NEAR(graded.at({1, 0, 0}), 0.1, 0.01);
}

TEST(SizeField, FollowsScaleAndShift) {
  const SurfaceMesh surface = torus(50, 20);
  const SizeField h = make(surface, {});
  for (const double scale : {1e-6, 0.25, 1e6}) {
    const Vec3 shift = scale * Vec3{3, -2, 5};
    const SizeField other = make(transformed(surface, scale, shift), {});
    std::mt19937 random(3);
    for (int n = 0; n < 200; ++n) {
      const Vec3 p = random_point(random, bounding_box(surface.points));
      ASSERT_NEAR(other.at(scale * p + shift) / scale, h.at(p), 0.02 * h.at(p));
    }
  }
}

TEST(SizeField, IsTheSameEveryTime) {
  const SizeField a = make(torus(60, 24), {}), b = make(torus(60, 24), {});
  EXPECT_EQ(as_octree_field(a)->h, as_octree_field(b)->h);
}

TEST(ExpectedTets, OfACube) {
  SizeOptions o;
  o.size = 0.05;
  const double n = expected_tets(make(cube(4), o), cube(4));
  EXPECT_NEAR(n, kTetsPerCube * 8000, 1);
  o.callback = each([](Vec3) { return 0.05; });
  EXPECT_NEAR(expected_tets(make(cube(4), o), cube(4)), n, 0.01 * n);
}

/// One layer of prisms, three elements for the two triangles of each, however thin.
TEST(ExpectedTets, OfAPlateThinnerThanItsElements) {
  SizeOptions o;
  o.size = 0.02;
  const double one_layer = 1.5 * 2 * 4 / std::sqrt(3) / (0.02 * 0.02);
  for (const double thickness : {1e-2, 1e-3, 1e-5, 1e-9}) {
    const SurfaceMesh plate = box(1, 1, thickness, 1);
    EXPECT_NEAR(expected_tets(make(plate, o), plate), one_layer, 0.05 * one_layer) << thickness;
  }
}

TEST(ExpectedTets, MeetsTheTarget) {
  for (const std::int64_t elements : {3000, 100000, 2000000}) {
    SizeOptions o;
    o.elements = elements;
    const SurfaceMesh surface = torus(60, 24);
    EXPECT_NEAR(expected_tets(make(surface, o), surface), elements, 0.02 * elements);
  }
}

TEST(CappedNear, LowersTheSizeThereAndStaysGraded) {
  for (const SizeField& h : {SizeField::uniform(0.2), make(icosphere(3), {})}) {
    const Vec3 at{1, 0, 0};
    const SizeField capped = capped_near(h, {at, {0, 1, 0}}, 0.5, RunContext{});
    EXPECT_NEAR(capped.at(at), 0.5 * h.at(at), 0.05 * h.at(at));
    EXPECT_NEAR(capped.at({-1, 0, 0}), h.at({-1, 0, 0}), 0.02 * h.at({-1, 0, 0}));
    std::mt19937 random(5);
    Box3 box;
    box.add(Vec3{-1, -1, -1});
    box.add(Vec3{1, 1, 1});
    for (int n = 0; n < 5000; ++n) {
      const Vec3 p = random_point(random, box), q = random_point(random, box);
      ASSERT_LE(capped.at(p), h.at(p) * (1 + 1e-9));
      ASSERT_LE(std::abs(capped.at(p) - capped.at(q)), 0.2 * distance(p, q) * (1 + 1e-9));
    }
  }
}

TEST(WithinCount, RaisesSmallSizesButNotAboveTheFirst) {
  const SurfaceMesh ball = icosphere(3);
  const SizeField first = make(ball, {}), finer = capped_at(first, {{{1, 0, 0}, 0.01}, {{0, -1, 0}, 0.02}}, {});
  const TetPrediction expected(ball);
  const double few = expected(first), many = expected(finer), most = std::sqrt(few * many);
  ASSERT_GT(many, 1.5 * few);
  EXPECT_EQ(within_count(finer, first, expected, 1.1 * many, {}).floor, 0);
  const WithinCount met = within_count(finer, first, expected, most, {});
  EXPECT_EQ(met.asked, many);
  EXPECT_GT(met.floor, 0.01);
  EXPECT_NEAR(expected(met.sizes) / most, 1, 0.1);
  EXPECT_LE(expected(within_count(finer, first, expected, 1, {}).sizes), 1.02 * few);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> at(-1, 1);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p{at(random), at(random), at(random)};
    EXPECT_LE(met.sizes.at(p), first.at(p) * 1.001);
    EXPECT_GE(met.sizes.at(p), finer.at(p) * 0.999);
  }
}

TEST(AutomaticBudget, GrowsWithTheTrianglesAndIsTheUsersOwnWhereHeChooses) {
  const SurfaceMesh ball = icosphere(2), fine = icosphere(4);
  EXPECT_GT(automatic_budget(fine, {}), automatic_budget(ball, {}));
  SizeOptions o;
  o.automatic_factor = 2;
  EXPECT_EQ(automatic_budget(ball, o), automatic_budget(ball, {}) / 8);
  o.curvature = 30;
  EXPECT_EQ(automatic_budget(ball, o), HUGE_VAL);
}

/// A largest size is no wish for details: what it makes by itself comes on top, and no more.
TEST(AutomaticBudget, HoldsBelowALargestSize) {
  const SurfaceMesh ball = icosphere(2);
  SizeOptions o;
  o.max_size = 0.5;
  EXPECT_GT(automatic_budget(ball, o), automatic_budget(ball, {}));
  EXPECT_LT(automatic_budget(ball, o), 1.01 * automatic_budget(ball, {}));
  SurfaceMesh plates = box(1, 1, 0.002);
  for (int k = 1; k < 20; ++k) plates = testing::joined(plates, transformed(box(1, 1, 0.002), 1, {0, 0, 0.016 * k}));
  const KnownSurface known(plates, 40);
  StageReport report;
  const double budget = 100'000;
  const SizeField sizes = make_size_field(known, o, {RunContext{}, report}, {}, budget);
  EXPECT_LT(expected_tets(sizes, plates), 1.1 * budget);
  EXPECT_LE(sizes.max_size(), *o.max_size);
}

/// Thousands of thin walls: raising the smallest sizes a little does not help.
TEST(AutomaticBudget, HoldsForDetailsWithoutEnd) {
  SurfaceMesh plates = box(1, 1, 0.002);
  for (int k = 1; k < 60; ++k) plates = testing::joined(plates, transformed(box(1, 1, 0.002), 1, {0, 0, 0.016 * k}));
  const KnownSurface known(plates, 40);
  StageReport report;
  const double budget = 100'000;
  const SizeField sizes = make_size_field(known, {}, {RunContext{}, report}, {}, budget);
  EXPECT_LT(expected_tets(sizes, plates), 1.1 * budget);
  ASSERT_EQ(report.notes.size(), 1u);
  EXPECT_NE(report.notes[0].find("at most 0.1 million"), std::string::npos) << report.notes[0];
}

/// Their details are counted on the surface alone.
TEST(AutomaticBudget, HoldsForManyBodies) {
  const SurfaceMesh ball = icosphere(1);
  SurfaceMesh balls = ball;
  for (int k = 1; k < 64; ++k)
    balls = testing::joined(balls, transformed(ball, 1, 3 * Vec3{double(k % 4), double(k / 4 % 4), double(k / 16)}));
  const KnownSurface known(balls, 40);
  StageReport report;
  const double budget = 50'000;
  const SizeField sizes = make_size_field(known, {}, {RunContext{}, report}, {}, budget);
  const double expected = expected_tets(sizes, balls);
  EXPECT_LT(expected, 1.1 * budget);
  EXPECT_GT(expected, 0.1 * budget);
  EXPECT_EQ(report.notes.size(), 1u);
}

TEST(Scaled, MultipliesAllSizes) {
  const SizeField h = make(torus(60, 24), {}), twice = scaled(h, 2, RunContext{});
  EXPECT_DOUBLE_EQ(twice.at({1, 0.2, 0.1}), 2 * h.at({1, 0.2, 0.1}));
  EXPECT_DOUBLE_EQ(scaled(SizeField::uniform(3), 2, RunContext{}).at({}), 6);
}

TEST(PackedSizes, AnswerWithTheSameBits) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const SizeField field = make(c.surface, c.options);
    const SizeField again = unpacked_sizes(packed_sizes(field));
    EXPECT_EQ(SizeFunction::behind(again).gradation, SizeFunction::behind(field).gradation);
    EXPECT_EQ(again.min_size(), field.min_size());
    EXPECT_EQ(again.max_size(), field.max_size());
    for (const Vec3 p : c.surface.points) EXPECT_EQ(again.at(0.9 * p), field.at(0.9 * p));
  }
  EXPECT_EQ(unpacked_sizes(packed_sizes(SizeField::uniform(0.3))).at({}), 0.3);
}

TEST(PackedSizes, WhatHasNoGridAndWhatIsDamagedIsRefused) {
  const SizeField rising = SizeField::from_function([](Vec3 p) { return p.x; }, 1, 2);
  EXPECT_THROW(packed_sizes(rising), OptionError);
  SizeOptions options;
  options.size = 0.5;
  const std::string good = packed_sizes(make(cube(1), options));
  for (const std::size_t length : {std::size_t{0}, std::size_t{7}, good.size() / 2, good.size() - 1})
    EXPECT_THROW(unpacked_sizes(std::string_view(good).substr(0, length)), InputError) << length;
  EXPECT_THROW(unpacked_sizes(good + good), InputError);
  // The mark, the number of leaves, the first key, the sign of the last size.
  for (const std::size_t at : {std::size_t{0}, std::size_t{8}, std::size_t{56}, good.size() - 1}) {
    std::string damaged = good;
    damaged[at] ^= '\x80';
    EXPECT_THROW(unpacked_sizes(damaged), InputError) << at;
  }
}

TEST(ChangedSizes, StopWhenAsked) {
  const std::atomic<bool> stop{true};
  RunContext context;
  context.cancel = &stop;
  const Vec3 p{1, 0, 0};
  for (const SizeField& h : {SizeField::uniform(0.2), make(icosphere(3), {})}) {
    EXPECT_THROW(capped_near(h, {p}, 0.5, context), Cancelled);
    EXPECT_THROW(capped_at(h, {{p, 0.1}}, context), Cancelled);
    EXPECT_THROW(scaled(h, 2, context), Cancelled);
  }
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
    EXPECT_THROW(make(cube(), o), OptionError);
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

/// With the number, and before anything is divided: the stage has no leaves to count yet.
TEST(SizeOptions, WhatNoMeshCanHoldIsRefusedBeforeWorkBegins) {
  const auto refused = [](const char* name, auto&& change) {
    SizeOptions o;
    change(o);
    StageReport report;
    const bool is_curved = o.curvature || o.chord_error;
    const KnownSurface surface(is_curved ? icosphere(3) : box(2, 2, 0.1, 1), 40);
    try {
      make_size_field(surface, o, {RunContext{}, report});
      ADD_FAILURE() << name;
    } catch (const OptionError& e) {
      EXPECT_NE(std::string(e.what()).find(name), std::string::npos) << e.what();
      EXPECT_NE(std::string(e.what()).find("elements, more than the"), std::string::npos) << e.what();
    }
    for (const auto& [what, count] : report.counters) EXPECT_NE(what, "leaves") << name;
  };
  refused("size", [](SizeOptions& o) { o.size = 1e-5; });
  refused("curvature", [](SizeOptions& o) { o.curvature = 1e6; });
  refused("gap", [](SizeOptions& o) { o.gap = 1e4; });
  refused("feature_elements", [](SizeOptions& o) { o.feature_elements = 1e9; });
  refused("max_deviation", [](SizeOptions& o) { o.chord_error = 1e-9; });
  EXPECT_THROW(refuse_huge_turning(KnownSurface(icosphere(3), 40), {}, 1e-3, RunContext{}), OptionError);
}

}  // namespace
}  // namespace octafront
