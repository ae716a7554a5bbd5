// Surfaces between grey values.

#include <octafront/error.h>
#include <octafront/image_surface.h>
#include <octafront/repair.h>

#include "support/random.h"
#include "voxel_images.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

namespace octafront {
namespace {

constexpr double kEndless = std::numeric_limits<double>::infinity();

using testing::grey_image;
using testing::grid_around_origin;

void expect_no_defects(const SurfaceMesh& surface) {
  const RepairedSurface repaired = repair_surface(surface);
  EXPECT_TRUE(repaired.notes.empty()) << repaired.notes.front();
  const SurfaceDefects defects = find_defects(repaired);
  EXPECT_TRUE(defects.clean()) << defects.describe();
}

TEST(ComplexOfBands, ABallLiesWhereItsValuesSay) {
  for (const double voxel : {1.0, 0.5, 0.25}) {
    const auto n = static_cast<std::uint32_t>(20 / voxel);
    const Image image = grey_image(testing::turned(grid_around_origin({n, n, n}, {voxel, voxel, voxel}), 12),
                                   [](Vec3 p) { return 100 * std::exp(-squared_length(p) / 50); });
    const double radius = 7.1, iso = 100 * std::exp(-radius * radius / 50);
    const Complex complex = complex_of_bands(image, {{iso, kEndless, "ball"}});
    expect_no_defects(complex.surface);
    double worst = 0;
    for (const Vec3 p : complex.surface.points) worst = std::max(worst, std::abs(length(p) - radius));
    // What is linear between voxels errs by an eighth of the second derivative at most, about.
    EXPECT_LT(worst, 0.1 * voxel * voxel);
    EXPECT_NEAR(complex.volumes[0] / (4.0 / 3 * std::numbers::pi * radius * radius * radius), 1, 0.02 * voxel * voxel);
  }
}

TEST(ComplexOfBands, BandsNest) {
  const Image image = grey_image(grid_around_origin({24, 24, 24}, {1, 1, 1}), [](Vec3 p) { return 20 - length(p); });
  const Complex complex = complex_of_bands(image, {{16, kEndless, "core"}, {10, 16, "mantle"}, {11 - 2.5, 10, "skin"}});
  expect_no_defects(complex.surface);
  ASSERT_EQ(complex.surface.region_names, (std::vector<std::string>{"core", "mantle", "skin"}));
  const auto ball = [](double r) { return 4.0 / 3 * std::numbers::pi * r * r * r; };
  EXPECT_NEAR(complex.volumes[0] / ball(4), 1, 0.06);
  EXPECT_NEAR(complex.volumes[1] / (ball(10) - ball(4)), 1, 0.01);
  EXPECT_NEAR(complex.volumes[2] / (ball(11.5) - ball(10)), 1, 0.02);
}

TEST(ComplexOfBands, NoiseIsAlwaysAComplex) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(seed);
    testing::Random random(seed);
    const Image image =
        grey_image(grid_around_origin({9, 8, 7}, {1, 1, 1.5}), [&](Vec3) { return random.integer(0, 20); });
    expect_no_defects(complex_of_bands(image, {{5, 10, "low"}, {10, 16, "middle"}, {18, kEndless, "high"}}).surface);
  }
}

TEST(ComplexOfBands, RefusesBandsThatMakeNoSense) {
  const Image image = grey_image(grid_around_origin({4, 4, 4}, {1, 1, 1}), [](Vec3 p) { return p.x; });
  EXPECT_THROW(complex_of_bands(image, {}), InputError);
  EXPECT_THROW(complex_of_bands(image, {{1, 1, "a"}}), InputError);
  EXPECT_THROW(complex_of_bands(image, {{0, 1, "a"}, {0.5, 2, "b"}}), InputError);
  EXPECT_THROW(complex_of_bands(image, {{100, kEndless, "a"}}), InputError);
}

}  // namespace
}  // namespace octafront
