// Sizes where a body is round, or its walls curve, and it is thinner than what the user asked for.

#include "sizing/size_cases.h"
#include "sizing/sources/surface_samples.h"
#include "support/named_surfaces.h"
#include "support/thin_surfaces.h"

#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using testing::sizes_of;

SizeOptions of_size(double size) {
  SizeOptions o;
  o.size = size;
  return o;
}

TEST(RoundPlaces, AThinRodHasElevenElementsToATurn) {
  for (const double scale : {1e-3, 1.0, 1e6}) {
    const SurfaceMesh rod = testing::transformed(testing::rod(24, 0.05, 4), scale, {});
    const SizeField sizes = sizes_of(rod, of_size(0.2 * scale));
    EXPECT_NEAR(sizes.at(scale * Vec3{0.05, 0, 2}) / scale, 2 * std::numbers::pi * 0.05 / 11, 1e-3);
  }
}

TEST(RoundPlaces, ANeedleHasSmallerOnesTowardsItsTipButNotWithoutEnd) {
  const SizeField sizes = sizes_of(testing::needle(24, 0.05, 4), of_size(0.2));
  EXPECT_NEAR(sizes.at({0.025, 0, 2}) / sizes.at({0.0375, 0, 1}), 2.0 / 3, 0.05);
  EXPECT_GT(sizes.min_size(), 0.2 / 33);
}

TEST(RoundPlaces, TheLeastSizeIsHeld) {
  SizeOptions o = of_size(0.2);
  o.min_size = 0.1;
  EXPECT_GT(sizes_of(testing::rod(24, 0.05, 4), o).min_size(), 0.0999);
}

TEST(RoundPlaces, ChordsAreNoDeeperThanHalfOfACurvedWall) {
  for (const double scale : {1e-3, 1.0, 1e6}) {
    const SurfaceMesh shell = testing::transformed(testing::hollow_sphere(4, 1, 0.99), scale, {});
    const SizeField sizes = sizes_of(shell, of_size(0.5 * scale));
    EXPECT_NEAR(sizes.at(scale * Vec3{1, 0, 0}) / scale, 0.2, 0.04);
    EXPECT_NEAR(sizes.at(scale * Vec3{0, 0, 0.99}) / scale, 0.2, 0.04);
    EXPECT_GT(sizes_of(shell, of_size(0.15 * scale)).min_size() / scale, 0.149);
  }
}

TEST(RoundPlaces, FilletsThickTubesAndWhatIsThickAreNone) {
  EXPECT_GT(sizes_of(testing::icosphere(3), of_size(0.4)).min_size(), 0.399);
  EXPECT_GT(sizes_of(testing::hollow_sphere(3, 1, 0.95), of_size(0.3)).min_size(), 0.299);
  const SurfaceMesh plate = testing::box(1, 1, 0.01, 4);
  EXPECT_GT(sizes_of(plate, of_size(0.3), detect_features(plate, 40)).min_size(), 0.299);
}

TEST(RoundPlaces, SamplesOfLongTrianglesAreInProportion) {
  const SurfaceMesh rod = testing::rod(24, 0.05, 40);
  const double h = 0.01;
  const auto samples = sample_surface(rod, std::vector<double>(rod.triangles.size(), h), {}, RunContext{});
  double area_of_samples = 0;
  for (const SizeSample& s : samples) area_of_samples += s.area;
  EXPECT_NEAR(area_of_samples / area(rod), 1, 1e-9);
  EXPECT_LT(static_cast<double>(samples.size()), 12 * area(rod) / (h * h));
}

}  // namespace
}  // namespace octafront
