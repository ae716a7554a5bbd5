#include <octafront/error.h>
#include <octafront/size_field.h>

#include "sizing/field/change_size_field.h"
#include "sizing/field/octree_field.h"
#include "sizing/field/packed_sizes.h"
#include "sizing/size_cases.h"
#include "support/named_surfaces.h"

#include <atomic>
#include <cmath>
#include <random>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using testing::box;
using testing::cube;
using testing::icosphere;
using testing::random_point;
using testing::size_cases;
using testing::SizeCase;
using testing::sizes_of;
using testing::torus;
using testing::transformed;

TEST(SizeField, ObeysItsGradationBetweenAnyTwoPoints) {
  std::mt19937 random(1);
  for (const SizeCase& c : size_cases()) {
    SCOPED_TRACE(c.name);
    const SizeField h = sizes_of(c.surface, c.options);
    const Box3 box = bounding_box(c.surface.points);
    const double gradation = as_octree_field(h)->gradation;
    EXPECT_EQ(gradation, c.options.gradation.value_or(gradation));
    std::uniform_real_distribution<double> exponent(-4, 0);
    for (int n = 0; n < 20000; ++n) {
      const Vec3 p = random_point(random, box);
      const Vec3 q = p + (random_point(random, box) - p) * std::pow(10, exponent(random));
      ASSERT_LE(std::abs(h.at(p) - h.at(q)), gradation * distance(p, q) * (1 + 1e-9) + 1e-14 * h.max_size());
    }
  }
}

TEST(SizeField, IsContinuousAcrossLeaves) {
  for (const SizeCase& c : size_cases()) {
    SCOPED_TRACE(c.name);
    const SizeField field = sizes_of(c.surface, c.options);
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

TEST(SizeField, FollowsScaleAndShift) {
  const SurfaceMesh surface = torus(50, 20);
  const SizeField h = sizes_of(surface, {});
  for (const double scale : {1e-6, 0.25, 1e6}) {
    const Vec3 shift = scale * Vec3{3, -2, 5};
    const SizeField other = sizes_of(transformed(surface, scale, shift), {});
    std::mt19937 random(3);
    for (int n = 0; n < 200; ++n) {
      const Vec3 p = random_point(random, bounding_box(surface.points));
      ASSERT_NEAR(other.at(scale * p + shift) / scale, h.at(p), 0.02 * h.at(p));
    }
  }
}

/// An edge of the size, in whatever direction, has length 1 by the metric; shorter ones have less.
TEST(SizeField, MetricsMeasureEdgesInSizes) {
  const SurfaceMesh surface = torus(50, 20);
  const SizeField h = sizes_of(surface, {});
  std::mt19937 random(4);
  for (int n = 0; n < 200; ++n) {
    const Vec3 p = random_point(random, bounding_box(surface.points));
    const Vec3 edge = h.at(p) * normalized(random_point(random, {{-1, -1, -1}, {1, 1, 1}}));
    const auto metric = h.metric_at(p);
    double squared = 0;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        EXPECT_EQ(metric[i][j], metric[j][i]);
        squared += edge[i] * metric[i][j] * edge[j];
      }
    }
    ASSERT_NEAR(squared, 1, 1e-12);
  }
  EXPECT_EQ(SizeField::uniform(0.5).metric_at({})[2][2], 4);
}

TEST(SizeField, IsTheSameEveryTime) {
  const SizeField a = sizes_of(torus(60, 24), {}), b = sizes_of(torus(60, 24), {});
  EXPECT_EQ(as_octree_field(a)->h, as_octree_field(b)->h);
}

TEST(CappedNear, LowersTheSizeThereAndStaysGraded) {
  for (const SizeField& h : {SizeField::uniform(0.2), sizes_of(icosphere(3), {})}) {
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

TEST(Scaled, MultipliesAllSizes) {
  const SizeField h = sizes_of(torus(60, 24), {}), twice = scaled(h, 2, RunContext{});
  EXPECT_DOUBLE_EQ(twice.at({1, 0.2, 0.1}), 2 * h.at({1, 0.2, 0.1}));
  EXPECT_DOUBLE_EQ(scaled(SizeField::uniform(3), 2, RunContext{}).at({}), 6);
}

TEST(PackedSizes, AnswerWithTheSameBits) {
  for (const SizeCase& c : size_cases()) {
    SCOPED_TRACE(c.name);
    const SizeField field = sizes_of(c.surface, c.options);
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
  const std::string good = packed_sizes(sizes_of(cube(1), options));
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
  for (const SizeField& h : {SizeField::uniform(0.2), sizes_of(icosphere(3), {})}) {
    EXPECT_THROW(capped_near(h, {p}, 0.5, context), Cancelled);
    EXPECT_THROW(capped_at(h, {{p, 0.1}}, context), Cancelled);
    EXPECT_THROW(scaled(h, 2, context), Cancelled);
  }
}

}  // namespace
}  // namespace octafront
