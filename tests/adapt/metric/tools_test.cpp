#include <octafront/adapt.h>
#include <octafront/error.h>
#include <octafront/metric.h>

#include "adapt/metric/background.h"
#include "adapt/metric/metric.h"
#include "improve/start_meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using namespace testing;

template <class Function>
std::vector<double> values_on(const TetMesh& mesh, const Function& function) {
  std::vector<double> values;
  for (const Vec3 p : mesh.points) values.push_back(function(p));
  return values;
}

double apart(const Metric& a, const Metric& b) {
  const Metric d = a + -1.0 * b;
  return std::max({std::abs(d.xx), std::abs(d.xy), std::abs(d.xz), std::abs(d.yy), std::abs(d.yz), std::abs(d.zz)});
}

TEST(MetricTools, IntersectionIsAsFineAsBothAndTouchesThem) {
  const Metric a{100, 0, 0, 1, 0, 4}, b{1, 0, 0, 25, 0, 4};
  EXPECT_LT(apart(adapt::intersection(a, b), {100, 0, 0, 25, 0, 4}), 1e-12);
  const Metric c{30, 12, 3, 20, -4, 9};
  const Metric both = adapt::intersection(b, c);
  double least_b = 10, least_c = 10;
  for (int i = 0; i < 400; ++i) {
    const Vec3 e{std::sin(i), std::cos(2.1 * i), std::sin(0.7 * i + 1)};
    least_b = std::min(least_b, both.squared(e) / b.squared(e));
    least_c = std::min(least_c, both.squared(e) / c.squared(e));
  }
  EXPECT_GE(least_b, 1 - 1e-12);
  EXPECT_GE(least_c, 1 - 1e-12);
  EXPECT_LT(least_b, 1.05);
  EXPECT_LT(least_c, 1.05);
  EXPECT_EQ(adapt::intersection(a, 0.5 * a), a);
  EXPECT_EQ(adapt::intersection(0.5 * a, a), a);
}

TEST(MetricTools, ImpliedMetricOfARegularLattice) {
  // All edges of a stretched Kuhn cube have, on average of logarithms, the density of its elements.
  TetMesh mesh = kuhn_cube(4);
  for (Vec3& p : mesh.points) p.x *= 10;
  const std::vector<Metric> implied = metrics::implied(mesh);
  const double each = 10.0 / static_cast<double>(mesh.tets.size());
  for (const Metric& m : implied) EXPECT_NEAR(adapt::density_of(m) * each / (std::sqrt(2.0) / 12), 1, 1e-9);
  EXPECT_NEAR(metrics::complexity(mesh, implied), std::sqrt(2.0) / 12 * static_cast<double>(mesh.tets.size()), 1e-6);
}

TEST(MetricTools, ComplexityIsMetWithinBounds) {
  const TetMesh mesh = kuhn_cube(6);
  std::vector<Metric> m;
  for (const Vec3 p : mesh.points) m.push_back({1 + 500 * p.x, 0, 0, 2, 0.5, 1 + 3 * p.y});
  EXPECT_NEAR(metrics::complexity(mesh, metrics::with_complexity(mesh, m, 5000)), 5000, 1e-6);
  const metrics::Bounds bounds{0.03, 0.1};
  const std::vector<Metric> bounded = metrics::with_complexity(mesh, m, 5000, bounds);
  EXPECT_NEAR(metrics::complexity(mesh, bounded), 5000, 1e-3);
  for (const Metric& b : bounded)
    for (const double value : adapt::eigen(b).value) {
      EXPECT_GE(value, 1 / 0.01 * (1 - 1e-9));
      EXPECT_LE(value, 1 / 0.0009 * (1 + 1e-9));
    }
  EXPECT_THROW(metrics::with_complexity(mesh, m, 0), OptionError);
  EXPECT_THROW(metrics::with_complexity(mesh, m, 10, {2, 1}), OptionError);
  m[3].xx = -1;
  EXPECT_THROW(metrics::complexity(mesh, m), InputError);
}

TEST(MetricTools, GradingOfASizeGrowsWithDistance) {
  const TetMesh mesh = kuhn_cube(12);
  std::vector<Metric> m(mesh.points.size(), Metric::of_size(1));
  std::size_t at = 0;
  for (std::size_t v = 0; v < m.size(); ++v)
    if (length(mesh.points[v] - Vec3{0, 0, 0}) == 0) at = v;
  m[at] = Metric::of_size(0.01);
  const std::vector<Metric> graded = metrics::graded(mesh, m, 0.3);
  for (std::size_t v = 0; v < m.size(); ++v) {
    const double h = 1 / std::sqrt(graded[v].xx), away = length(mesh.points[v]);
    EXPECT_GE(h, std::min(1.0, 0.01 + 0.3 * away) * 0.995) << away;
    // Along edges of the mesh the way is longer: the l1-distance at most.
    const Vec3 p = mesh.points[v];
    EXPECT_LE(h, std::min(1.0, 0.01 + 0.3 * (p.x + p.y + p.z)) * 1.02) << away;
  }
  EXPECT_EQ(graded[at], m[at]);
  // It is done: once more changes nothing.
  EXPECT_EQ(metrics::graded(mesh, graded, 0.3), graded);
  EXPECT_THROW(metrics::graded(mesh, m, 0), OptionError);
}

TEST(MetricTools, HessianOfAQuadraticIsExactAtTheBoundaryToo) {
  TetMesh mesh = kuhn_cube(5);
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
    mesh.points[v] += Vec3{std::sin(3.0 * v), std::sin(5.0 * v + 1), std::sin(7.0 * v)} * 0.03;
  const Metric h{3, -1, 0.5, -2, 4, 1};
  const auto found =
      metrics::hessians(mesh, values_on(mesh, [&](Vec3 p) { return 2 + p.x - 3 * p.z + 0.5 * h.squared(p); }));
  for (const Metric& f : found) EXPECT_LT(apart(f, h), 1e-6);
  EXPECT_THROW(metrics::hessians(mesh, std::vector<double>(3)), InputError);
  EXPECT_THROW(metrics::hessians(mesh, std::vector<double>(mesh.points.size(), NAN)), InputError);
}

TEST(MetricTools, HessianConvergesForASmoothField) {
  const auto field = [](Vec3 p) { return std::sin(2 * p.x) * std::exp(p.y) + p.z * p.z * p.z; };
  const auto worst = [&](int n) {
    const TetMesh mesh = kuhn_cube(n);
    const auto found = metrics::hessians(mesh, values_on(mesh, field));
    double most = 0;
    for (std::size_t v = 0; v < found.size(); ++v) {
      const Vec3 p = mesh.points[v];
      const double s = std::sin(2 * p.x) * std::exp(p.y), c = 2 * std::cos(2 * p.x) * std::exp(p.y);
      most = std::max(most, apart(found[v], {-4 * s, c, 0, s, 0, 6 * p.z}));
    }
    return most;
  };
  const double coarse = worst(8), fine = worst(16);
  EXPECT_LT(fine, 0.6 * coarse);
  EXPECT_LT(fine, 2);
}

/// The norm in L^2 of the difference between a field and its linear interpolant, by a rule of degree 2 on eight parts.
template <class Function>
double interpolation_error(const TetMesh& mesh, const Function& field) {
  double sum = 0;
  for (const Tet& t : mesh.tets) {
    std::array<Vec3, 4> x;
    std::array<double, 4> u;
    for (std::size_t i = 0; i < 4; ++i) x[i] = mesh.points[t[i]], u[i] = field(x[i]);
    const double volume = dot(cross(x[1] - x[0], x[2] - x[0]), x[3] - x[0]) / 6;
    constexpr double kNear = 0.58541019662496852, kFar = 0.13819660112501050;
    for (std::size_t k = 0; k < 4; ++k) {
      Vec3 p;
      double linear = 0;
      for (std::size_t i = 0; i < 4; ++i) p += x[i] * (i == k ? kNear : kFar), linear += u[i] * (i == k ? kNear : kFar);
      sum += volume / 4 * (field(p) - linear) * (field(p) - linear);
    }
  }
  return std::sqrt(sum);
}

/// A layer as thin as 1/4 across the cube.
double layer(Vec3 p) {
  return std::tanh(4 * (p.x + 0.3 * p.y - 0.6)) + p.z * p.z;
}

AdaptedMesh fitted_to_layer(double elements, int loops, int threads = 0) {
  AdaptedMesh made;
  made.mesh = kuhn_cube(8);
  RunContext context;
  context.threads = threads;
  for (int i = 0; i < loops; ++i) {
    MetricMesh metric{made.mesh.points, made.mesh.tets, {}, {}};
    metric.metrics = metrics::of_field(made.mesh, values_on(made.mesh, layer), {.elements = elements}, context);
    made = adapt_to_metric(made.mesh, metric, {}, context);
  }
  return made;
}

TEST(MetricTools, AdaptedMeshesBeatUniformOnesByTheSlopeOfTheory) {
  const AdaptedMesh coarse = fitted_to_layer(1500, 2), fine = fitted_to_layer(6000, 2);
  EXPECT_NEAR(static_cast<double>(fine.mesh.tets.size()), 6000, 0.2 * 6000);
  const double e1 = interpolation_error(coarse.mesh, layer), e2 = interpolation_error(fine.mesh, layer);
  const double slope = std::log(e2 / e1) / std::log(static_cast<double>(fine.mesh.tets.size()) /
                                                    static_cast<double>(coarse.mesh.tets.size()));
  // Of second order: -2/3 in the end, more while the layer is still being found.
  EXPECT_LT(slope, -0.55) << e1 << " to " << e2;
  const TetMesh uniform = kuhn_cube(10);  // 6,000 elements
  EXPECT_LT(2 * e2, interpolation_error(uniform, layer));
}

TEST(MetricTools, SameMeshForAnyNumberOfThreads) {
  EXPECT_EQ(fitted_to_layer(3000, 2, 1).mesh, fitted_to_layer(3000, 2, 4).mesh);
}

TEST(MetricTools, LinearFieldIsRefused) {
  const TetMesh mesh = kuhn_cube(2);
  EXPECT_THROW(metrics::of_field(mesh, std::vector<double>(mesh.points.size(), 1), {.elements = 100}), InputError);
  EXPECT_THROW(metrics::of_field(mesh, std::vector<double>(mesh.points.size(), 1), {}), OptionError);
}

TEST(BackgroundMetric, LogarithmsAreLinear) {
  const TetMesh mesh = kuhn_cube(2);
  MetricMesh background{mesh.points, mesh.tets, {}, {}};
  for (const Vec3 p : mesh.points) background.metrics.push_back(Metric::of_size(std::exp(p.x - 2 * p.y + p.z)));
  const adapt::BackgroundMetric metric(background);
  EXPECT_TRUE(metric.is_isotropic());
  std::uint32_t hint = 0;
  for (const Vec3 p : {Vec3{0.2, 0.3, 0.4}, Vec3{0.9, 0.11, 0.5}, Vec3{1, 1, 0.3}}) {
    EXPECT_NEAR(1 / std::sqrt(metric.at(p, hint).xx), std::exp(p.x - 2 * p.y + p.z), 1e-9);
    EXPECT_NEAR(metric.at(p, hint).xy, 0, 1e-9);
  }
  // Outside: the nearest place.
  EXPECT_NEAR(1 / std::sqrt(metric.at({2, 0.5, 0.5}, hint).xx), std::exp(1 - 1 + 0.5), 1e-9);
}

TEST(BackgroundMetric, RefusesWhatIsNoMetricWithItsPlace) {
  const TetMesh mesh = kuhn_cube(1);
  MetricMesh background{mesh.points, mesh.tets, {}, std::vector<Metric>(mesh.points.size())};
  background.metrics[5].yy = -2;
  try {
    adapt_to_metric(mesh, background);
    FAIL() << "taken";
  } catch (const InputError& error) {
    EXPECT_NE(std::strstr(error.what(), "point 5"), nullptr) << error.what();
  }
  background.metrics.pop_back();
  EXPECT_THROW(adapt_to_metric(mesh, background), InputError);
}

}  // namespace
}  // namespace octafront
