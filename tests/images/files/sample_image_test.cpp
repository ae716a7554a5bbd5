// Values of an image on a mesh.

#include <octafront/error.h>
#include <octafront/image_samples.h>

#include "support/rich_mesh.h"

#include <cmath>

#include <gtest/gtest.h>

namespace octafront {
namespace {

constexpr double kTiny = 1e-9;

/// 2 x + 3 y - z of the world, on a grid that is turned and sheared, and whose slices are unequal.
Image linear_image(double step, std::uint32_t n, bool unequal) {
  Image image;
  image.grid.size = {n, n, n};
  image.grid.axes = {{{0, step, 0}, {-step, 0, 0}, {0, 0.1 * step, step}}};
  const double extent = n * step;
  image.grid.origin = {extent / 2, -extent / 4, -extent / 3};
  if (unequal)
    for (std::uint32_t k = 0; k < n; ++k) image.grid.slices.push_back(k + 0.3 * (k % 2));
  std::vector<float> values;
  for (std::uint32_t k = 0; k < n; ++k)
    for (std::uint32_t j = 0; j < n; ++j)
      for (std::uint32_t i = 0; i < n; ++i) {
        const Vec3 p = image.grid.to_world({double(i), double(j), image.grid.slice(k)});
        values.push_back(static_cast<float>(2 * p.x + 3 * p.y - p.z));
      }
  image.values = std::move(values);
  return image;
}

Vec3 middle_of(const TetMesh& mesh, std::size_t t) {
  const auto& [a, b, c, d] = mesh.tets[t];
  return (mesh.points[a] + mesh.points[b] + mesh.points[c] + mesh.points[d]) * .25;
}

double linear(Vec3 p) {
  return 2 * p.x + 3 * p.y - p.z;
}

TEST(SampleImage, WhatIsLinearIsMetAtNodesAndInSmallElements) {
  const TetMesh mesh = testing::with_mid_nodes(testing::rich_mesh(2));
  const ImageSamples samples = sample_image(mesh, linear_image(.5, 20, true), "HU");
  EXPECT_TRUE(samples.notes.empty());
  ASSERT_EQ(samples.at_points.values.size(), mesh.points.size());
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
    EXPECT_NEAR(samples.at_points.values[v], linear(mesh.points[v]), 1e-5);
  const ImageSamples coarse = sample_image(mesh, linear_image(1, 12, false), "HU");
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    EXPECT_NEAR(coarse.of_elements.values[t], linear(middle_of(mesh, t)), 1e-5);
}

TEST(SampleImage, LargeElementsHaveTheMeanOfTheirVoxels) {
  const TetMesh mesh = testing::rich_mesh(2);
  Image image = linear_image(.1, 80, false);
  auto& values = std::get<std::vector<float>>(image.values);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i * 7919 % 101);  // noise
  const ImageSamples samples = sample_image(mesh, image, "HU");
  for (const std::size_t t : {std::size_t{0}, mesh.tets.size() / 2, mesh.tets.size() - 1}) {
    const auto& [a, b, c, d] = mesh.tets[t];
    const auto volume = [&](Vec3 p, Vec3 q, Vec3 r, Vec3 s) { return dot(q - p, cross(r - p, s - p)); };
    const auto& p = mesh.points;
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const Vec3 x = image.grid.to_world({double(i % 80), double(i / 80 % 80), double(i / 6400)});
      const bool inside = volume(x, p[b], p[c], p[d]) >= -kTiny && volume(p[a], x, p[c], p[d]) >= -kTiny &&
                          volume(p[a], p[b], x, p[d]) >= -kTiny && volume(p[a], p[b], p[c], x) >= -kTiny;
      if (inside) sum += values[i], ++count;
    }
    ASSERT_GT(count, 100);
    EXPECT_NEAR(samples.of_elements.values[t], sum / count, 1.5);  // voxels on faces may fall to either side
  }
}

TEST(SampleImage, ElementsOutsideAreToldAndAWholeMeshOutsideIsRefused) {
  TetMesh mesh = testing::rich_mesh(4);
  Image image = linear_image(1, 12, false);
  for (Vec3& p : mesh.points) p.z += 7;
  const ImageSamples samples = sample_image(mesh, image, "HU");
  ASSERT_EQ(samples.notes.size(), 1u);
  EXPECT_NE(samples.notes[0].find("outside"), std::string::npos);
  for (const double value : samples.at_points.values) EXPECT_TRUE(std::isfinite(value));
  for (Vec3& p : mesh.points) p.z += 100;
  EXPECT_THROW(sample_image(mesh, image, "HU"), InputError);
}

TEST(SampleImage, WedgesHaveOneValue) {
  TetMesh mesh = testing::rich_mesh(2);
  mesh.wide_cells = {{0, 3, {}}};
  const ImageSamples samples = sample_image(mesh, linear_image(1, 12, false), "HU");
  EXPECT_EQ(samples.of_elements.values[0], samples.of_elements.values[2]);
  EXPECT_NE(samples.of_elements.values[2], samples.of_elements.values[3]);
}

TEST(SampleImage, FramesAreTurnedIntoEachOther) {
  Image image = linear_image(1, 4, false);
  image.frame = "LPS";
  const Vec3 p{1, 2, 3}, there = image.grid.to_world(p);
  const Image turned = in_frame(image, "RAS");
  EXPECT_EQ(turned.grid.to_world(p), (Vec3{-there.x, -there.y, there.z}));
  EXPECT_EQ(in_frame(image, "").grid, image.grid);
  EXPECT_EQ(in_frame(image, "LPS").grid, image.grid);
}

}  // namespace
}  // namespace octafront
