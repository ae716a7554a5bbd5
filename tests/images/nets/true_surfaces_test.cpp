// Bodies whose surfaces are known, as labels of voxels: how near to them the net comes, and how evenly it turns.

#include <octafront/image_surface.h>

#include "voxel_images.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using testing::grid_around_origin;
using testing::label_image;
using testing::turned;

/// A surface by the signed distance of a point, and the direction in which that grows.
struct TrueSurface {
  std::function<double(Vec3)> distance;
  std::function<Vec3(Vec3)> normal;
};

TrueSurface sphere(double radius) {
  return {[=](Vec3 p) { return length(p) - radius; }, [](Vec3 p) { return normalized(p); }};
}

TrueSurface torus(double ring, double tube) {
  const auto from_ring = [=](Vec3 p) {
    const double r = std::hypot(p.x, p.y);
    return Vec3{p.x * (1 - ring / r), p.y * (1 - ring / r), p.z};
  };
  return {[=](Vec3 p) { return length(from_ring(p)) - tube; }, [=](Vec3 p) { return normalized(from_ring(p)); }};
}

struct Measured {
  double mean_angle, angle_of_95, mean_distance, largest_distance;
};

/// The triangles that `counts` says are of the surface.
Measured measure(const SurfaceMesh& made, const TrueSurface& truth, const std::function<bool(Vec3)>& counts) {
  std::vector<double> angles;
  double angle_sum = 0, distance_sum = 0, largest = 0;
  for (const Triangle& t : made.triangles) {
    const Vec3 a = made.points[t[0]], b = made.points[t[1]], c = made.points[t[2]], middle = (a + b + c) / 3;
    if (!counts(middle)) continue;
    const double cosine = std::abs(dot(normalized(cross(b - a, c - a)), truth.normal(middle)));
    angles.push_back(std::acos(std::min(1.0, cosine)) * 180 / std::numbers::pi);
    angle_sum += angles.back();
    distance_sum += std::abs(truth.distance(middle));
    largest = std::max(largest, std::abs(truth.distance(middle)));
  }
  std::sort(angles.begin(), angles.end());
  const auto n = static_cast<double>(angles.size());
  return {angle_sum / n, angles[angles.size() * 95 / 100], distance_sum / n, largest};
}

void show(const char* what, double voxel, const Measured& m) {
  std::printf("%-28s voxel %.3g: normals %.2f mean %.2f at 95 %%; distance %.3f mean %.3f largest, in voxels\n", what,
              voxel, m.mean_angle, m.angle_of_95, m.mean_distance / voxel, m.largest_distance / voxel);
}

bool everywhere(Vec3) {
  return true;
}

Measured measured_ball(double radius, double voxel, Vec3 shape, double degrees) {
  const auto size = [&](double s) { return static_cast<std::uint32_t>(2 * radius / (voxel * s)) + 5; };
  const ImageGrid grid =
      turned(grid_around_origin({size(shape.x), size(shape.y), size(shape.z)}, shape * voxel), degrees);
  const TrueSurface truth = sphere(radius);
  const auto image = label_image(grid, 1, [&](Vec3 p) { return truth.distance(p) < 0 ? 0 : -1; });
  return measure(complex_of_labels(image).surface, truth, everywhere);
}

TEST(TrueSurfaces, BallsAreRound) {
  double last = 1e300;
  for (const double voxel : {1.0, 0.5, 0.25}) {
    const Measured plain = measured_ball(20, voxel, {1, 1, 1}, 0), turned = measured_ball(20, voxel, {1, 1, 1}, 31);
    show("ball", voxel, plain);
    show("ball, turned", voxel, turned);
    EXPECT_LT(plain.angle_of_95, 4);
    EXPECT_LT(turned.angle_of_95, 4);
    EXPECT_LT(plain.largest_distance, 0.75 * last);
    EXPECT_LT(plain.largest_distance, 0.5 * voxel);
    last = plain.largest_distance;
  }
}

TEST(TrueSurfaces, FlatVoxelsMakeRoundBallsToo) {
  for (const double voxel : {1.0, 0.5}) {
    const Measured m = measured_ball(24, voxel, {1, 1, 2}, 17);
    show("ball, voxels 1:1:2, turned", voxel, m);
    EXPECT_LT(m.angle_of_95, 5);
    EXPECT_LT(m.largest_distance, voxel);
  }
}

TEST(TrueSurfaces, ShellsKeepBothTheirSurfaces) {
  for (const double voxel : {1.0, 0.5}) {
    const auto n = static_cast<std::uint32_t>(52 / voxel);
    const auto image = label_image(grid_around_origin({n, n, n}, {voxel, voxel, voxel}), 2, [](Vec3 p) {
      return length(p) < 20 ? 0 : length(p) < 24 ? 1 : -1;
    });
    const SurfaceMesh made = complex_of_labels(image).surface;
    for (const double radius : {20.0, 24.0}) {
      const Measured m = measure(made, sphere(radius), [&](Vec3 p) { return (length(p) < 22) == (radius == 20); });
      show("shell", voxel, m);
      EXPECT_LT(m.angle_of_95, 4);
      EXPECT_LT(m.largest_distance, 0.5 * voxel);
    }
  }
}

TEST(TrueSurfaces, ToriAreRound) {
  for (const double voxel : {1.0, 0.5}) {
    const ImageGrid grid =
        turned(grid_around_origin({static_cast<std::uint32_t>(40 / voxel), static_cast<std::uint32_t>(40 / voxel),
                                   static_cast<std::uint32_t>(40 / voxel)},
                                  {voxel, voxel, voxel}),
               20);
    const TrueSurface truth = torus(12, 5);
    const auto image = label_image(grid, 1, [&](Vec3 p) { return truth.distance(p) < 0 ? 0 : -1; });
    const Measured m = measure(complex_of_labels(image).surface, truth, everywhere);
    show("torus", voxel, m);
    EXPECT_LT(m.angle_of_95, 9);
    EXPECT_LT(m.largest_distance, 0.6 * voxel);
  }
}

TEST(TrueSurfaces, TerracesBecomeSlopes) {
  // A plane that rises by one voxel in twenty, whose terraces run askew.
  const Vec3 normal = normalized({-0.04, -0.03, 1});
  const TrueSurface truth{[=](Vec3 p) { return dot(p, normal); }, [=](Vec3) { return normal; }};
  const auto image = label_image(grid_around_origin({120, 120, 20}, {1, 1, 1}), 1,
                                 [&](Vec3 p) { return truth.distance(p) < 0.01 ? 0 : -1; });
  const Measured m = measure(complex_of_labels(image).surface, truth,
                             [](Vec3 p) { return std::abs(p.z) < 6 && std::abs(p.x) < 50 && std::abs(p.y) < 50; });
  show("terraces 1/20", 1, m);
  EXPECT_LT(m.angle_of_95, 1.5);
}

TEST(TrueSurfaces, LinesWhereThreeLabelsMeetLieWhereTheyShould) {
  // Thirds of a ball: lines along a slanted axis, planes through it.
  const Vec3 axis = normalized({1, 2, 5}), side = normalized(cross(axis, {1, 0, 0})), other = cross(axis, side);
  const auto third = [&](Vec3 p) {
    const double turn = std::atan2(dot(p, other), dot(p, side)) / (2 * std::numbers::pi) + 0.5;
    return std::min(2, static_cast<int>(3 * turn));
  };
  const auto image = label_image(grid_around_origin({40, 40, 40}, {1, 1, 1}), 3,
                                 [&](Vec3 p) { return length(p) < 16 ? third(p) : -1; });
  const SurfaceMesh made = complex_of_labels(image).surface;
  std::vector<int> labels(made.points.size(), 0);
  for (std::size_t t = 0; t < made.triangles.size(); ++t)
    for (const VertexIndex v : made.triangles[t])
      for (const std::uint32_t r : made.sides[t]) labels[v] |= r == kNone ? 8 : 1 << r;
  double sum = 0, largest = 0;
  int lines = 0;
  for (std::size_t v = 0; v < made.points.size(); ++v) {
    if (labels[v] != 7 || length(made.points[v]) > 13) continue;
    const double off = length(cross(made.points[v], axis));
    sum += off;
    largest = std::max(largest, off);
    ++lines;
  }
  std::printf("line of three labels: %.3f voxels off in the mean, %.3f at most, %d vertices\n", sum / lines, largest,
              lines);
  EXPECT_LT(sum / lines, 0.25);
}

}  // namespace
}  // namespace octafront
