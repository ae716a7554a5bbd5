// Labels with closed surfaces of their own: voxels near these follow them, and vertices lie on them.

#include <octafront/error.h>
#include <octafront/image_surface.h>

#include "base/geometry/triangle_tree.h"
#include "support/named_surfaces.h"
#include "voxel_images.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using testing::grey_image;
using testing::grid_around_origin;
using testing::icosphere;
using testing::turned;

ImageGrid grid_of(double half, Vec3 voxel, double degrees = 0) {
  const auto size = [&](double step) { return static_cast<std::uint32_t>(2 * half / step); };
  return turned(grid_around_origin({size(voxel.x), size(voxel.y), size(voxel.z)}, voxel), degrees);
}

/// Labels by the distance from the origin: values[i] below radii[i].
Image shells(const ImageGrid& grid, const std::vector<std::pair<double, int>>& radii) {
  return grey_image(grid, [&](Vec3 p) {
    for (const auto& [radius, value] : radii)
      if (length(p) < radius) return value;
    return 0;
  });
}

Complex complex_with(const Image& image, std::vector<SurfaceOfLabel> surfaces) {
  ImageRegions regions;
  regions.kind = ImageRegions::Kind::kLabels;
  regions.surfaces = std::move(surfaces);
  return complex_of_image(image, regions);
}

/// Vertices of triangles that have one of the regions on just one side.
std::set<VertexIndex> vertices_around(const Complex& complex, const std::set<std::string>& regions) {
  const SurfaceMesh& s = complex.surface;
  const auto holds = [&](std::uint32_t r) { return r != kNone && regions.contains(s.region_names[r]); };
  std::set<VertexIndex> vertices;
  for (std::size_t t = 0; t < s.triangles.size(); ++t)
    if (holds(s.sides[t][0]) != holds(s.sides[t][1])) vertices.insert(s.triangles[t].begin(), s.triangles[t].end());
  return vertices;
}

double largest_distance(const Complex& complex, const std::set<std::string>& regions, const SurfaceMesh& surface) {
  const TriangleTree tree(surface);
  double largest = 0;
  for (const VertexIndex v : vertices_around(complex, regions))
    largest = std::max(largest, std::sqrt(tree.nearest(complex.surface.points[v]).squared_distance));
  return largest;
}

std::string refusal(const std::function<void()>& run) {
  try {
    run();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "nothing";
}

void expect_parts(const std::string& text, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) EXPECT_NE(text.find(part), std::string::npos) << part << " in: " << text;
}

TEST(GivenSurfaces, VerticesOfABallLieOnItsSphere) {
  const SurfaceMesh sphere = icosphere(5, 20);
  const double truth = enclosed_volume(sphere);
  for (const double labelled : {18.0, 20.0, 22.0})
    for (const auto& [voxel, degrees] : {std::pair(Vec3{2, 2, 2}, 0.0), std::pair(Vec3{2, 2, 3}, 31.0)}) {
      const Image image = shells(grid_of(28, voxel, degrees), {{labelled, 7}});
      const Complex made = complex_with(image, {{"7", sphere, "ball.stl"}});
      const double largest = largest_distance(made, {"label 7"}, sphere);
      std::printf("labels to %g: %g from the sphere, volume %+.2f %%\n", labelled, largest,
                  100 * (made.volumes[0] / truth - 1));
      EXPECT_LT(largest, 1e-9) << labelled;
      EXPECT_NEAR(made.volumes[0] / truth, 1, 0.015);
      expect_parts(made.notes.at(1), {"\"label 7\" follows ball.stl", "near it another label"});
    }
}

TEST(GivenSurfaces, OneLiesWithinAnother) {
  const SurfaceMesh white = icosphere(5, 14), pial = icosphere(5, 20);
  // Labels that are too large inside and too small outside, so that grey matter is half as thick as it should be.
  const Image image = shells(grid_of(30, {1.5, 1.5, 1.5}), {{5, 4}, {15.5, 1}, {18.5, 2}, {26, 3}});
  const Complex made = complex_with(image, {{"2", pial, "pial.stl"}, {"1", white, "white.stl"}});
  EXPECT_LT(largest_distance(made, {"label 1", "label 4"}, white), 1e-9);
  EXPECT_LT(largest_distance(made, {"label 1", "label 2", "label 4"}, pial), 1e-9);
  const auto ball = [](double r) { return 4.18879 * r * r * r; };
  const auto volume = [&](std::size_t r) { return made.volumes[r]; };  // of 1, 2, 3 and 4
  EXPECT_NEAR(volume(0) / (ball(14) - ball(5)), 1, 0.03);
  EXPECT_NEAR(volume(1) / (ball(20) - ball(14)), 1, 0.02);
  EXPECT_NEAR(volume(2) / (ball(26) - ball(20)), 1, 0.01);
  EXPECT_NEAR(volume(3) / ball(5), 1, 0.05);
}

TEST(GivenSurfaces, LabelsThatGoOnFarFromTheSurfaceStay) {
  // Two balls of one label that touch, and the surface of one of them: the other one stays but for what is near.
  const ImageGrid grid = grid_of(40, {2, 2, 2});
  const Image image = grey_image(grid, [](Vec3 p) {
    return length(p) < 12 || length(p - Vec3{22, 0, 0}) < 12 ? 1 : 0;
  });
  const Complex made = complex_with(image, {{"1", icosphere(4, 12), "one.stl"}});
  EXPECT_GT(made.volumes[0], 1.7 * 4.18879 * 12 * 12 * 12);
}

TEST(GivenSurfaces, HalvesOfOneLabelAreTakenTogether) {
  SurfaceMesh left = icosphere(4, 12), right = left;
  for (Vec3& p : left.points) p.x -= 15;
  for (Vec3& p : right.points) p.x += 15;
  const Image image =
      grey_image(grid_of(32, {2, 2, 2}), [](Vec3 p) { return std::hypot(std::abs(p.x) - 15, p.y, p.z) < 12; });
  const Complex made = complex_with(image, {{"label 1", left, "lh.stl"}, {"1", right, "rh.stl"}});
  EXPECT_NEAR(made.volumes[0] / (2 * enclosed_volume(left)), 1, 0.02);
  expect_parts(made.notes.at(1), {"lh.stl, rh.stl"});
}

TEST(GivenSurfaces, WhatDoesNotFitIsRefused) {
  const Image image = shells(grid_of(28, {2, 2, 2}), {{20, 7}});
  const SurfaceMesh sphere = icosphere(3, 20);
  const auto with = [&](const SurfaceOfLabel& given) { return refusal([&] { complex_with(image, {given}); }); };
  SurfaceMesh open = sphere, far = sphere;
  open.triangles.pop_back();
  for (Vec3& p : far.points) p.x += 80;
  expect_parts(with({"7", open, "open.stl"}), {"open.stl", "label \"7\"", "not closed", "3 edges", "octafront repair"});
  expect_parts(with({"7", far, "far.stl"}),
               {"far.stl", "\"label 7\"", "within 2 voxels", "RAS or LPS", "(60, -20, -20)"});
  expect_parts(with({"liver", sphere, "ball.stl"}), {"`surface_of`", "ball.stl", "\"liver\"", "\"label 7\" (7)"});
  expect_parts(refusal([&] {
                 ImageRegions regions;
                 regions.bands = {{1, 8, "ball"}};
                 regions.surfaces = {{"7", sphere, "ball.stl"}};
                 complex_of_image(image, regions);
               }),
               {"`surface_of` is for images of labels"});
}

}  // namespace
}  // namespace octafront
