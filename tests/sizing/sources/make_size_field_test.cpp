
#include "sizing/sources/make_size_field.h"

#include <octafront/error.h>

#include "sizing/field/change_size_field.h"
#include "sizing/field/expected_tets.h"
#include "sizing/size_cases.h"
#include "sizing/sources/budget.h"
#include "sizing/sources/curvature.h"
#include "support/named_surfaces.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using testing::box;
using testing::icosphere;
using testing::sizes_of;
using testing::torus;
using testing::transformed;

TEST(SizeField, AutomaticSizesOfSecondOrderAreTwiceAsLarge) {
  const SurfaceMesh box = testing::cube(1);
  const KnownSurface known(box, detect_features(box, 40));
  StageReport report;
  const auto size = [&](bool curved) {
    return make_size_field(known, {}, {RunContext{}, report}, {.curved = curved}).at({0.5, 0.5, 0.5});
  };
  EXPECT_DOUBLE_EQ(size(true), 2 * size(false));
}

/// Thinner than what the automatic size resolves, a plate gets wider elements and not more of them.
TEST(SizeField, AutomaticSizesFollowThePlateSmoothly) {
  constexpr double kStep = 0.65;  // of the thickness; the count of a plate with one layer falls with its square
  double before = 0;
  for (double thickness = 0.1; thickness > 1e-4; thickness *= kStep) {
    const SurfaceMesh plate = box(1, 1, thickness, 1);
    const double n = expected_tets(sizes_of(plate, {}, detect_features(plate, 40)), plate);
    EXPECT_LT(n, 450'000) << thickness;
    if (before > 0) {
      EXPECT_LT(std::abs(std::log(n / before)), 2.6 * std::log(1 / kStep)) << thickness;
    }
    before = n;
  }
  EXPECT_LT(before, 10'000);
}

double gradation_of(const SurfaceMesh& surface, const SizeOptions& options, bool curved = false) {
  const KnownSurface known(surface, {});
  StageReport report;
  return as_octree_field(make_size_field(known, options, {RunContext{}, report}, {.curved = curved}))->gradation;
}

/// Where sizes are alike they rise slowly; towards few small places fast, so that these do not rule the whole.
TEST(SizeField, GradationFollowsFromTheSpreadOfSizes) {
  SizeOptions options;
  EXPECT_EQ(gradation_of(icosphere(3), options), kDefaultGradation);
  options.size = 0.1;
  EXPECT_EQ(gradation_of(icosphere(3), options), kDefaultGradation);
  SizeOptions spread;
  spread.point_sizes = {{{1, 0, 0}, 0.01}, {{-1, 0, 0}, 0.3}, {{0, 1, 0}, 0.3}, {{0, -1, 0}, 0.3}, {{0, 0, 1}, 0.3}};
  const double steep = gradation_of(icosphere(3), spread);
  EXPECT_GE(steep, 0.3);
  EXPECT_LE(steep, 0.4);
  EXPECT_GT(gradation_of(icosphere(3), spread, true), 0.4);
  spread.elements = 20'000;
  EXPECT_EQ(gradation_of(icosphere(3), spread), kDefaultGradation);
  EXPECT_GT(gradation_of(icosphere(3), spread, true), kDefaultGradation);
  spread.elements = {};
  spread.gradation = 0.2;
  EXPECT_EQ(gradation_of(icosphere(3), spread), 0.2);
}

/// A ball with small cavities in it: sizes rise from each of them.
SurfaceMesh ball_with_bubbles() {
  SurfaceMesh made = icosphere(3);
  for (const double x : {-0.5, -0.25, 0.0, 0.25, 0.5})
    for (const double y : {-0.5, -0.25, 0.0, 0.25, 0.5}) {
      SurfaceMesh bubble = icosphere(1);
      const auto first = static_cast<VertexIndex>(made.points.size());
      for (const Vec3& p : bubble.points) made.points.push_back(0.02 * p + Vec3{x, y, 0});
      for (const auto& [a, b, c] : bubble.triangles) made.triangles.push_back({first + a, first + c, first + b});
    }
  return made;
}

TEST(SizeField, OfTrueGeometrySizesMayRiseFaster) {
  const SurfaceMesh surface = ball_with_bubbles();
  const KnownSurface known(surface, Features{});
  const auto gradation = [&](double turns) {
    StageReport report;
    return as_octree_field(make_size_field(known, {}, {RunContext{}, report}, {.turns = turns}))->gradation;
  };
  EXPECT_EQ(gradation(0), kSteepestGradation);
  EXPECT_GT(gradation(12), kSteepestGradation);
}

TEST(ExpectedTets, MeetsTheTarget) {
  for (const std::int64_t elements : {3000, 100000, 2000000}) {
    SizeOptions o;
    o.elements = elements;
    const SurfaceMesh surface = torus(60, 24);
    EXPECT_NEAR(expected_tets(sizes_of(surface, o), surface), elements, 0.02 * elements);
  }
}

TEST(WithinCount, RaisesSmallSizesButNotAboveTheFirst) {
  const SurfaceMesh ball = icosphere(3);
  const SizeField first = sizes_of(ball, {}), finer = capped_at(first, {{{1, 0, 0}, 0.01}, {{0, -1, 0}, 0.02}}, {});
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
    EXPECT_GE(met.sizes.at(p), finer.at(p) * 0.99);  // gradation takes off up to .6 % more here or there
  }
}

TEST(AutomaticBudget, GrowsWithTheTrianglesAndIsTheUsersOwnWhereHeChooses) {
  const SurfaceMesh ball = icosphere(2), fine = icosphere(4);
  EXPECT_GT(automatic_budget(fine, {}), automatic_budget(ball, {}));
  SizeOptions o;
  o.automatic_factor = 0.5;
  EXPECT_EQ(automatic_budget(ball, o), automatic_budget(ball, {}) * 8);
  o.automatic_factor = 10;
  EXPECT_EQ(automatic_budget(ball, o), 50'000);
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
  for (int k = 1; k < 150; ++k) plates = testing::joined(plates, transformed(box(1, 1, 0.002), 1, {0, 0, 0.0065 * k}));
  const KnownSurface known(plates, 40);
  StageReport report;
  const double budget = 100'000;
  const SizeField sizes = make_size_field(known, {}, {RunContext{}, report}, {}, budget);
  EXPECT_LT(expected_tets(sizes, plates), 1.1 * budget);
  ASSERT_GE(report.notes.size(), 1u);
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
