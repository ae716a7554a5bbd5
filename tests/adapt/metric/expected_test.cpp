#include "adapt/metric/expected.h"

#include <octafront/adapt.h>
#include <octafront/error.h>

#include "improve/start_meshes.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using ::octafront::testing::kuhn_cube;
using ::octafront::testing::transformed;

MetricMesh metric_on(const TetMesh& mesh, const Metric& metric) {
  return {mesh.points, mesh.tets, {}, std::vector<Metric>(mesh.points.size(), metric), "wanted.sol"};
}

std::string refusal(const TetMesh& mesh, const MetricMesh& metric) {
  try {
    adapt_to_metric(mesh, metric);
  } catch (const Error& error) {
    return error.what();
  }
  return "taken";
}

class Shell : public adapt::MetricField {
 public:
  adapt::Metric at(Vec3 p, std::uint32_t&) const override {
    return adapt::Metric::of_size(0.01 + std::abs(length(p) - 0.7));
  }
};

TEST(ExpectedElements, AgreeWithTheIntegralWhateverTheMesh) {
  // In the eighth of a ball: the integral of pi / 2 r^2 / (.01 + |r - .7|)^3 is near pi / 2 .49 / .01^2.
  const double fine = adapt::expected_tets(kuhn_cube(24), Shell{}),
               coarse = adapt::expected_tets(kuhn_cube(1), Shell{});
  EXPECT_NEAR(fine / (metrics::kElementsPerComplexity * 1.5708 * 0.49 / 1e-4), 1, 0.15);
  EXPECT_NEAR(coarse / fine, 1, 0.15);
}

TEST(ExpectedElements, WhatNoMeshCanHoldIsRefusedWithTheCount) {
  for (const double scale : {1e-3, 1.0, 1e6}) {
    const TetMesh mesh = transformed(kuhn_cube(3), scale, {});
    EXPECT_NE(refusal(mesh, metric_on(mesh, Metric::of_size(1e-4 * scale))).find("about 1.02e+13 elements"),
              std::string::npos);
    MetricMesh one = metric_on(mesh, Metric::of_size(0.3 * scale));
    one.metrics.back() = Metric::of_size(1e-12 * scale);
    EXPECT_NE(refusal(mesh, one).find("elements, more than"), std::string::npos);
  }
}

TEST(ExpectedElements, SurfacesAreCountedInTriangles) {
  SurfaceMesh surface;
  const TetMesh cube = kuhn_cube(2);
  surface.points = cube.points, surface.triangles = cube.boundary;
  const adapt::SizeMetric metric{SizeField::uniform(0.05)};
  EXPECT_NEAR(adapt::expected_triangles(surface, metric), 6 * 2.3 / 0.0025, 60);
}

TEST(ExpectedElements, LengthsOutOfRangeAndWhatIsNoMetricAreTold) {
  const TetMesh mesh = kuhn_cube(2);
  EXPECT_NE(refusal(mesh, metric_on(mesh, Metric::of_size(1e30))).find("out of range"), std::string::npos);
  EXPECT_NE(refusal(mesh, metric_on(mesh, Metric::of_size(1e60))).find("out of range"), std::string::npos);
  EXPECT_NE(refusal(mesh, metric_on(mesh, {1, 2, 0, 1, 0, 1})).find("not positive definite"), std::string::npos);
  for (const double wrong : {std::nan(""), HUGE_VAL, 0.0, -1.0})
    EXPECT_NE(refusal(mesh, metric_on(mesh, {wrong, 0, 0, 1, 0, 1})).find("not positive definite"), std::string::npos);
}

/// One point wants elements a million times as flat as they are wide, its neighbours none such: nothing follows that.
TEST(ExpectedElements, AnOutlierOfAMetricEnds) {
  const TetMesh mesh = kuhn_cube(1);
  MetricMesh metric = metric_on(mesh, Metric::of_size(0.5));
  metric.metrics[2].zz = 1e7;
  EXPECT_EQ(refusal(mesh, metric), "taken");
}

}  // namespace
}  // namespace octafront
