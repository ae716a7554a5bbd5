// Complexes of labels: valid whatever the labels are, true to their volumes, the same on any number of threads.

#include <octafront/error.h>
#include <octafront/generate.h>
#include <octafront/image_surface.h>
#include <octafront/repair.h>
#include <octafront/run_context.h>

#include "base/geometry/hausdorff.h"
#include "base/mesh/complex.h"
#include "support/complexes.h"
#include "support/random.h"
#include "voxel_images.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using testing::grid_around_origin;
using testing::label_image;
using testing::noise;

/// Nothing for repair to do, and no defects.
void expect_clean(const SurfaceMesh& surface) {
  const RepairedSurface repaired = repair_surface(surface);
  EXPECT_TRUE(repaired.notes.empty()) << repaired.notes.front();
  EXPECT_EQ(repaired.surface.points.size(), surface.points.size());
  EXPECT_EQ(repaired.surface.triangles.size(), surface.triangles.size());
  const SurfaceDefects defects = find_defects(repaired);
  EXPECT_TRUE(defects.clean()) << defects.describe();
}

void expect_volumes(const Complex& complex, double tolerance) {
  const std::vector<double> made = testing::region_volumes(complex.surface);
  ASSERT_EQ(made.size(), complex.volumes.size());
  for (std::size_t r = 0; r < made.size(); ++r) EXPECT_NEAR(complex.volumes[r] / made[r], 1, tolerance);
}

int voxels_of(const LabelImage& image, int label) {
  return static_cast<int>(std::count(image.regions.begin(), image.regions.end(), label));
}

LabelImage labelled_ball(double radius, Vec3 spacing, std::uint32_t size) {
  return label_image(grid_around_origin({size, size, size}, spacing), 1,
                     [&](Vec3 p) { return length(p) < radius ? 0 : -1; });
}

TEST(ComplexOfLabels, NoiseIsAlwaysAComplexWithAllItsLabels) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    testing::Random random(seed);
    const int labels = random.integer(1, 4);
    const auto side = [&] { return static_cast<std::uint32_t>(random.integer(1, 7)); };
    const std::uint32_t a = side(), b = side(), c = side();
    const LabelImage image = noise({a, b, c}, labels, random.between(0.2, 1), seed);
    if (std::all_of(image.regions.begin(), image.regions.end(), [](auto r) { return r == LabelImage::kNoRegion; }))
      continue;
    for (const bool smooth : {false, true}) {
      const Complex complex = complex_of_labels(image, {smooth, smooth});
      expect_clean(complex.surface);
      expect_volumes(complex, 1e-9);
      for (std::size_t r = 0; r < complex.volumes.size(); ++r) EXPECT_GT(complex.volumes[r], 0);
      int used = 0;
      for (int l = 0; l < labels; ++l) used += voxels_of(image, l) > 0;
      EXPECT_EQ(complex.surface.region_names.size(), static_cast<std::size_t>(used));
    }
  }
}

TEST(ComplexOfLabels, EveryPairOfTwoCubesOfVoxelsIsAComplex) {
  // All ways to fill 2 x 2 x 2 voxels with two labels and none in which the first voxel has the first label.
  for (int code = 0; code < 3 * 3 * 3 * 3 * 3 * 3 * 3; code += 7) {
    SCOPED_TRACE(code);
    LabelImage image = noise({4, 4, 4}, 2, 0, 1);
    int rest = code;
    for (int o = 0; o < 8; ++o) {
      const int at = 1 + (o & 1) + 4 * (1 + (o >> 1 & 1)) + 16 * (1 + (o >> 2 & 1));
      const int digit = o == 0 ? 0 : rest % 3;
      if (o > 0) rest /= 3;
      image.regions[at] = digit == 2 ? LabelImage::kNoRegion : static_cast<std::uint16_t>(digit);
    }
    expect_clean(complex_of_labels(image).surface);
  }
}

TEST(ComplexOfLabels, FacesOfVoxelsAreKeptWithoutSmoothing) {
  const LabelImage image = labelled_ball(3.2, {1, 1, 1}, 9);
  const Complex complex = complex_of_labels(image, {false, false});
  expect_clean(complex.surface);
  EXPECT_NEAR(complex.volumes[0], voxels_of(image, 0), 1e-9);
}

TEST(ComplexOfLabels, ASingleVoxelSurvives) {
  for (const bool inside : {false, true}) {
    LabelImage image = label_image(grid_around_origin({9, 9, 9}, {1, 1, 2}), 2, [&](Vec3 p) {
      return length(p) < 0.1 ? 1 : inside ? 0 : -1;
    });
    const Complex complex = complex_of_labels(image);
    expect_clean(complex.surface);
    EXPECT_GT(complex.volumes.back(), 0.2 * 2);
  }
}

TEST(ComplexOfLabels, VolumesAreKept) {
  const LabelImage image =
      label_image(testing::turned(grid_around_origin({40, 40, 30}, {0.7, 0.7, 1.1}), 33), 3, [](Vec3 p) {
        const double r = length(p);
        return r > 12 ? -1 : r > 9 ? 2 : p.x > 0 ? 0 : 1;
      });
  const Complex complex = complex_of_labels(image);
  expect_clean(complex.surface);
  for (int l = 0; l < 3; ++l) EXPECT_NEAR(complex.volumes[l] / (voxels_of(image, l) * 0.7 * 0.7 * 1.1), 1, 1e-3);
}

TEST(ComplexOfLabels, TheBoxStaysFlatAndFull) {
  LabelImage image = noise({12, 9, 10}, 3, 1, 5);
  const Complex complex = complex_of_labels(image);
  expect_clean(complex.surface);
  EXPECT_NEAR(std::accumulate(complex.volumes.begin(), complex.volumes.end(), 0.0), 12 * 9 * 10, 1e-9);
  const Box3 box = bounding_box(complex.surface.points);
  EXPECT_EQ(box.lo, (Vec3{-6, -4.5, -5}));
  EXPECT_EQ(box.hi, (Vec3{6, 4.5, 5}));
  for (std::size_t t = 0; t < complex.surface.triangles.size(); ++t) {
    if (complex.surface.sides[t][0] != kNone) continue;
    const auto [a, b, c] = complex.surface.triangles[t];
    const Vec3 pa = complex.surface.points[a], pb = complex.surface.points[b], pc = complex.surface.points[c];
    bool flat = false;
    for (int axis = 0; axis < 3; ++axis)
      flat = flat ||
             (pa[axis] == pb[axis] && pa[axis] == pc[axis] && (pa[axis] == box.lo[axis] || pa[axis] == box.hi[axis]));
    EXPECT_TRUE(flat);
  }
}

TEST(ComplexOfLabels, AMirroredOrShearedGridFacesTheSameWay) {
  LabelImage image = noise({8, 8, 8}, 2, 0.6, 9);
  const Complex plain = complex_of_labels(image);
  image.grid.axes[0] = image.grid.axes[0] * -1;
  const Complex mirrored = complex_of_labels(image);
  expect_clean(mirrored.surface);
  expect_volumes(mirrored, 1e-9);
  for (std::size_t r = 0; r < plain.volumes.size(); ++r) EXPECT_NEAR(mirrored.volumes[r], plain.volumes[r], 1e-9);
  image.grid.axes[2] += image.grid.axes[1] * 0.3;
  const Complex sheared = complex_of_labels(image);
  expect_clean(sheared.surface);
  expect_volumes(sheared, 1e-9);
}

TEST(ComplexOfLabels, SlicesMayLieAtUnequalDistances) {
  ImageGrid grid = grid_around_origin({20, 20, 6}, {1, 1, 1});
  grid.slices = {0, 1, 2.5, 3, 5, 6};
  LabelImage image = label_image(grid, 1, [](Vec3 p) { return p.x * p.x + p.y * p.y < 49 ? 0 : -1; });
  const Complex complex = complex_of_labels(image);
  expect_clean(complex.surface);
  const double area = voxels_of(image, 0) / 6.0;
  EXPECT_NEAR(complex.volumes[0], area * 7, 1e-3 * area * 7);
}

TEST(ComplexOfLabels, TheSameBitsOnAnyNumberOfThreads) {
  const LabelImage image = noise({30, 30, 30}, 3, 0.7, 3);
  RunContext one, many;
  one.threads = 1;
  many.threads = 4;
  EXPECT_EQ(complex_of_labels(image, {}, one).surface, complex_of_labels(image, {}, many).surface);
}

TEST(ComplexOfLabels, RefusesWhatMakesNoSense) {
  const LabelImage good = labelled_ball(2, {1, 1, 1}, 5);
  LabelImage bad = good;
  bad.regions.pop_back();
  EXPECT_THROW(complex_of_labels(bad), InputError);
  bad = good;
  bad.regions[0] = 7;
  EXPECT_THROW(complex_of_labels(bad), InputError);
  bad = good;
  std::fill(bad.regions.begin(), bad.regions.end(), LabelImage::kNoRegion);
  EXPECT_THROW(complex_of_labels(bad), InputError);
  bad = good;
  bad.grid.axes[1] = bad.grid.axes[0];
  EXPECT_THROW(complex_of_labels(bad), InputError);
  bad = good;
  bad.grid.slices = {0, 1, 1, 2, 3};
  EXPECT_THROW(complex_of_labels(bad), InputError);
}

TEST(ImageOptions, FollowTheVoxelsUnlessToldOtherwise) {
  const Options automatic = options_for_voxels({}, 2);
  ASSERT_TRUE(automatic.size.chord_error);
  EXPECT_LT(*automatic.size.chord_error, 1);
  EXPECT_FALSE(automatic.surface.max_deviation);  // a budget may let it stray
  Options asked;
  asked.size.size = 2;
  Options made = options_for_voxels(asked, 2);
  ASSERT_TRUE(made.surface.max_deviation);
  EXPECT_LT(*made.surface.max_deviation, 1);
  EXPECT_GT(*made.surface.max_deviation, 0);
  EXPECT_EQ(given_up_for_size(asked, 2), "");
  asked.size.size = 12;  // coarser than voxels: the size rules
  made = options_for_voxels(asked, 2);
  EXPECT_GT(*made.surface.max_deviation, 2);
  EXPECT_EQ(made.surface.finest, 6);
  EXPECT_FALSE(made.size.gap);  // layers get flat elements
  EXPECT_FALSE(made.size.min_size);
  EXPECT_NE(given_up_for_size(asked, 2), "");
  EXPECT_GT(made.surface.angle_of_features(), asked.surface.angle_of_features());
  asked.surface.max_deviation = 3;
  asked.surface.feature_angle = kDefaultFeatureAngle;
  EXPECT_EQ(options_for_voxels(asked, 2).surface.max_deviation, 3);
  EXPECT_EQ(options_for_voxels(asked, 2).surface.feature_angle, kDefaultFeatureAngle);
  Options counted;
  counted.size.elements = 1000;
  EXPECT_FALSE(options_for_voxels(counted, 2).surface.max_deviation);
  Options kept;
  kept.surface.keep = true;
  EXPECT_FALSE(options_for_voxels(kept, 2).surface.max_deviation);
}

// A body with 27 labels of one voxel each in it: no size makes fewer elements than these need.
TEST(ImageOptions, ANumberOfElementsThatDetailsForbidIsGivenUpSoon) {
  const LabelImage image = label_image(grid_around_origin({15, 15, 15}, {1, 1, 1}), 28, [](Vec3 p) {
    const auto at = [](double x) { return std::abs(x) < 4.5 && std::fmod(x + 20, 4) == 0 ? int(x + 4) / 4 : -1; };
    if (at(p.x) >= 0 && at(p.y) >= 0 && at(p.z) >= 0) return 1 + at(p.x) + 3 * at(p.y) + 9 * at(p.z);
    return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) < 7 ? 0 : -1;
  });
  Options options;
  options.size.elements = 50;
  const Result made = generate(complex_of_labels(image).surface, options_for_voxels(options, 1));
  EXPECT_EQ(made.mesh.region_names.size(), 28u);
  const auto earlier = std::count_if(made.report.stages.begin(), made.report.stages.end(),
                                     [](const StageReport& s) { return s.name == "surface front (earlier try)"; });
  EXPECT_LE(earlier, 4);
}

/// How far the hull of a mesh by these options lies from that of the complex.
double strays(const SurfaceMesh& complex, const Options& options) {
  const TetMesh mesh = generate(complex, options_for_voxels(options, 1)).mesh;
  const SurfaceMesh hull{mesh.points, mesh.boundary, {}, {}, {}};
  return hausdorff_distance(hull_of(complex), hull, 0.02).lower;
}

// A body with ribs as thick as two voxels on it, of two labels: elements of four voxels cut them off.
TEST(ImageOptions, CoarseElementsStayAsNearAsAsked) {
  const LabelImage image = label_image(grid_around_origin({40, 40, 40}, {1, 1, 1}), 2, [](Vec3 p) {
    const double r = length(p), rib = std::abs(std::fmod(p.z + 100, 10) - 5);
    return r < 12 || (r < 15 && rib < 1.5) ? (p.x < 0 ? 0 : 1) : -1;
  });
  const SurfaceMesh complex = complex_of_labels(image).surface;
  Options options;
  options.size.size = 4;
  EXPECT_LT(strays(complex, options), 1.6);  // half of what the size exceeds the voxels by
  options.surface.max_deviation = 0.16;
  EXPECT_LT(strays(complex, options), 0.35);
  options.surface.max_deviation = 5;
  EXPECT_GT(strays(complex, options), 0.7);
}

// A ball of three labels with bumps of half a voxel that elements of four need not follow.
TEST(ImageOptions, ASizeCoarserThanVoxelsRules) {
  const LabelImage image = label_image(grid_around_origin({48, 48, 48}, {1, 1, 1}), 3, [](Vec3 p) {
    const double r = length(p) + 0.6 * std::sin(p.x) * std::sin(p.y) * std::sin(p.z);
    return r > 20 ? -1 : p.x < 0 ? 0 : p.y < 0 ? 1 : 2;
  });
  const SurfaceMesh complex = complex_of_labels(image).surface;
  const auto count = [&](const Options& options) {
    return static_cast<double>(generate(complex, options).mesh.tets.size());
  };
  Options by_size;
  by_size.size.size = 4;
  const double asked = count(by_size), made = count(options_for_voxels(by_size, 1));
  EXPECT_LT(made, 1.4 * asked);  // a small body: most of it is wedge
  EXPECT_GT(made, 0.7 * asked);
  by_size.surface.max_deviation = 0.16;
  EXPECT_GT(count(options_for_voxels(by_size, 1)), 1.6 * asked);  // what following the voxels takes
}

}  // namespace
}  // namespace octafront
