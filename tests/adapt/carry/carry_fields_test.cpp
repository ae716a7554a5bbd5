#include <octafront/adapt.h>
#include <octafront/carry.h>
#include <octafront/error.h>
#include <octafront/generate.h>
#include <octafront/improve_existing.h>

#include "base/core/elementary.h"
#include "base/geometry/measures.h"
#include "improve/start_meshes.h"
#include "support/named_surfaces.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using ::octafront::testing::kuhn_cube;
using ::octafront::testing::perturbed;
using Function = std::function<double(Vec3)>;

Vec3 middle_in(const TetMesh& mesh, TetIndex t) {
  const auto& [a, b, c, d] = mesh.tets[t];
  return centroid(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]);
}

MeshField of_elements(const TetMesh& mesh, const Function& f) {
  MeshField field{"f", true, 1, {}};
  for (TetIndex t = 0; t < mesh.tets.size(); ++t) field.values.push_back(f(middle_in(mesh, t)));
  return field;
}

MeshField at_nodes(const TetMesh& mesh, const Function& f) {
  MeshField field{"f", false, 1, {}};
  for (const Vec3& p : mesh.points) field.values.push_back(f(p));
  return field;
}

CarriedFields carry_one(const MeshField& field, const TetMesh& before, const TetMesh& now,
                        const CarryOptions& options = {}) {
  return carry_fields({&field, 1}, before, now, options);
}

/// Halves of the cube.
TetMesh with_regions(TetMesh mesh) {
  mesh.region.clear();
  for (TetIndex t = 0; t < mesh.tets.size(); ++t) mesh.region.push_back(middle_in(mesh, t).x > 0.5);
  mesh.patch.clear(), mesh.interfaces.clear(), mesh.interface_patch.clear();
  return mesh;
}

double wave(Vec3 p) {
  return elementary::cos(3 * p.x) * elementary::cos(2 * p.y) + p.z * p.z;
}

TEST(CarryFields, IntegralsStayAndNoExtremesComeBetweenMeshesOfOneBody) {
  const TetMesh old = perturbed(kuhn_cube(6), 0.25, 1);
  const auto steep = [](Vec3 p) { return p.x + p.y > 0.9 ? 7.0 : -2.0 + p.z; };
  const MeshField field = of_elements(old, steep);
  for (const int n : {3, 5, 9})
    for (const bool linear : {false, true}) {
      const TetMesh now = perturbed(kuhn_cube(n), 0.25, 7);
      const CarriedFields made = carry_one(field, old, now, {.linear_elements = linear});
      const FieldReport& report = made.report.fields.front();
      EXPECT_LT(report.integral_error, 1e-14);
      EXPECT_NEAR(report.after.integral[0], report.before.integral[0], 1e-13);
      EXPECT_GE(report.after.least[0], report.before.least[0]);
      EXPECT_LE(report.after.greatest[0], report.before.greatest[0]);
      EXPECT_EQ(report.beyond, 0);
      EXPECT_LT(made.report.uncovered, 1e-13);
      EXPECT_LT(made.report.lost, 1e-13);
    }
}

TEST(CarryFields, ConstantsKeepTheirBits) {
  const TetMesh old = perturbed(kuhn_cube(4), 0.25, 1), now = perturbed(kuhn_cube(7), 0.25, 2);
  const CarriedFields made = carry_one(of_elements(old, [](Vec3) { return 0.1; }), old, now);
  for (const double value : made.fields[0].values) EXPECT_EQ(value, 0.1);
}

TEST(CarryFields, TheSameMeshHasTheSameBitsInAnyOrder) {
  const TetMesh old = perturbed(kuhn_cube(4), 0.25, 1);
  TetMesh now = old;
  std::reverse(now.tets.begin(), now.tets.end());
  const std::vector<MeshField> fields{of_elements(old, wave), at_nodes(old, wave)};
  const CarriedFields made = carry_fields(fields, old, now);
  EXPECT_EQ(made.report.copied_elements, old.tets.size());
  EXPECT_EQ(made.report.copied_nodes, old.points.size());
  EXPECT_EQ(made.fields[1].values, fields[1].values);
  for (std::size_t t = 0; t < old.tets.size(); ++t)
    EXPECT_EQ(made.fields[0].values[t], fields[0].values[old.tets.size() - 1 - t]);
}

TEST(CarryFields, RegionsDoNotMixAndAreMatchedByName) {
  TetMesh old = with_regions(kuhn_cube(4)), now = with_regions(kuhn_cube(6));
  const MeshField field = of_elements(old, [](Vec3 p) { return p.x > 0.5 ? 1000 + p.y : p.z; });
  old.region_names = {"left", "right"}, now.region_names = {"right", "left"};
  for (std::uint32_t& r : now.region) r = 1 - r;
  const CarriedFields made = carry_one(field, old, now);
  EXPECT_TRUE(made.report.by_region);
  EXPECT_LT(made.report.fields[0].integral_error, 1e-14);
  for (TetIndex t = 0; t < now.tets.size(); ++t)
    EXPECT_EQ(made.fields[0].values[t] > 500, now.region_names[now.region[t]] == "right");
  now.region_names = {"right", "middle"};
  const CarriedFields mixed = carry_one(field, old, now);
  EXPECT_FALSE(mixed.report.by_region);
  EXPECT_EQ(mixed.report.notes.size(), 1u);
}

/// By which the error in L1 falls with the size of the elements. `field_on(mesh)` is exact.
template <class FieldOn>
double order_of(int n, const FieldOn& field_on, const CarryOptions& options) {
  std::vector<double> errors;
  for (const int cells : {n, 2 * n}) {
    const TetMesh old = perturbed(kuhn_cube(cells), 0.2, 1), now = perturbed(kuhn_cube(cells + 1), 0.2, 2);
    const auto made = carry_one(field_on(old, wave), old, now, options).fields[0].values;
    const auto wanted = field_on(now, wave).values;
    double error = 0;
    for (std::size_t i = 0; i < made.size(); ++i) error += std::abs(made[i] - wanted[i]);
    errors.push_back(error / static_cast<double>(made.size()));
  }
  return std::log2(errors[0] / errors[1]);
}

TEST(CarryFields, ElementsConvergeByTheirOrder) {
  EXPECT_GT(order_of(6, of_elements, {}), 0.8);
  EXPECT_GT(order_of(6, of_elements, {.linear_elements = true}), 1.7);
}

TEST(CarryFields, LinearElementsAreExactForLinearFunctionsInside) {
  const TetMesh old = perturbed(kuhn_cube(8), 0.2, 1), now = perturbed(kuhn_cube(9), 0.2, 2);
  const auto f = [](Vec3 p) { return 1 + 2 * p.x - 3 * p.y + p.z; };
  const auto made = carry_one(of_elements(old, f), old, now, {.linear_elements = true}).fields[0].values;
  std::size_t inside = 0;
  for (TetIndex t = 0; t < now.tets.size(); ++t) {
    const Vec3 p = middle_in(now, t);
    if (std::min({p.x, p.y, p.z}) < 0.35 || std::max({p.x, p.y, p.z}) > 0.65) continue;
    EXPECT_NEAR(made[t], f(p), 1e-9);
    ++inside;
  }
  EXPECT_GT(inside, 50u);
}

TEST(CarryFields, NodesAreLinearInsideAndNearestOutside) {
  const TetMesh old = perturbed(kuhn_cube(4), 0.2, 1);
  TetMesh now = perturbed(kuhn_cube(5), 0.2, 2);
  const auto f = [](Vec3 p) { return 1 + 2 * p.x - 3 * p.y + p.z; };
  const CarriedFields same = carry_one(at_nodes(old, f), old, now);
  for (std::size_t v = 0; v < now.points.size(); ++v) EXPECT_NEAR(same.fields[0].values[v], f(now.points[v]), 1e-13);
  EXPECT_EQ(same.report.outside_nodes, 0u);
  for (Vec3& p : now.points) p.z *= 1.5;
  const CarriedFields longer = carry_one(at_nodes(old, f), old, now);
  for (std::size_t v = 0; v < now.points.size(); ++v) {
    const Vec3 p = now.points[v];
    EXPECT_NEAR(longer.fields[0].values[v], f({p.x, p.y, std::min(p.z, 1.0)}), 1e-13);
  }
  EXPECT_GT(longer.report.outside_nodes, 36u);
  EXPECT_DOUBLE_EQ(longer.report.farthest, 0.5);
}

double bowl(Vec3 p) {
  return 1 + p.x - 2 * p.y + 3 * p.x * p.x - p.y * p.z + 0.5 * p.z * p.z;
}

TEST(CarryFields, QuadraticNodesAreExactForQuadraticFunctions) {
  const TetMesh old = perturbed(kuhn_cube(6), 0.2, 1), now = perturbed(kuhn_cube(7), 0.2, 2);
  const auto made = carry_one(at_nodes(old, bowl), old, now, {.quadratic_nodes = true}).fields[0].values;
  const auto linear = carry_one(at_nodes(old, bowl), old, now).fields[0].values;
  double worst = 0, worst_linear = 0;
  for (std::size_t v = 0; v < now.points.size(); ++v) {
    worst = std::max(worst, std::abs(made[v] - bowl(now.points[v])));
    worst_linear = std::max(worst_linear, std::abs(linear[v] - bowl(now.points[v])));
  }
  EXPECT_LT(worst, 1e-9);
  EXPECT_GT(worst_linear, 1e-3);
}

TEST(CarryFields, NodesConvergeByTheirOrder) {
  EXPECT_GT(order_of(8, at_nodes, {}), 1.7);
  EXPECT_GT(order_of(8, at_nodes, {.quadratic_nodes = true}), 2.7);
}

/// A ball of second order, its mid-side nodes on the sphere.
TetMesh curved_ball(double size) {
  Options options;
  options.size.size = size, options.order = 2;
  const SurfaceMesh sphere = testing::icosphere(4);
  TetMesh ball = generate(sphere, options).mesh;
  return ball;
}

TEST(CarryFields, MidSideNodesSpeakInsideCurvedElements) {
  const TetMesh old = curved_ball(0.3), now = curved_ball(0.22);
  ASSERT_TRUE(old.is_second_order());
  double mean[2] = {0, 0};
  for (const bool quadratic : {false, true}) {
    const auto made = carry_one(at_nodes(old, wave), old, now, {.quadratic_nodes = quadratic}).fields[0].values;
    for (std::size_t v = 0; v < now.points.size(); ++v)
      mean[quadratic] += std::abs(made[v] - wave(now.points[v])) / static_cast<double>(now.points.size());
  }
  EXPECT_LT(mean[true], 0.2 * mean[false]);
}

/// Four values in each element.
MeshField at_integration_points(const TetMesh& mesh, const Function& f) {
  MeshField field{"S", true, 4, {}};
  for (const Tet& tet : mesh.tets)
    for (const VertexIndex near : tet) {
      Vec3 p = (0.58541019662496845 - 0.13819660112501051) * mesh.points[near];
      for (const VertexIndex v : tet) p += 0.13819660112501051 * mesh.points[v];
      field.values.push_back(f(p));
    }
  return field;
}

TEST(CarryFields, IntegrationPointsKeepMeansAndRange) {
  const TetMesh old = perturbed(kuhn_cube(6), 0.2, 1), now = perturbed(kuhn_cube(7), 0.2, 2);
  const CarryOptions options{.integration_points = "S"};
  const MeshField field = at_integration_points(old, wave);
  EXPECT_EQ(carry_one(field, old, old, options).fields[0].values, field.values);
  const CarriedFields made = carry_one(field, old, now, options);
  const FieldReport& report = made.report.fields.front();
  EXPECT_EQ(report.components, 1u);
  EXPECT_LT(report.integral_error, 1e-14);
  EXPECT_GE(report.after.least[0], report.before.least[0]);
  EXPECT_LE(report.after.greatest[0], report.before.greatest[0]);
  const auto linear = [](Vec3 p) { return 1 + 2 * p.x - 3 * p.y + p.z; };
  const auto values = carry_one(at_integration_points(old, linear), old, now, options).fields[0].values;
  const auto wanted = at_integration_points(now, linear).values;
  double worst = 0;
  for (std::size_t i = 0; i < values.size(); ++i) worst = std::max(worst, std::abs(values[i] - wanted[i]));
  // The outermost points of the new mesh are beyond those of the old one, whose range is kept.
  EXPECT_LT(worst, 0.2);
  std::size_t exact = 0;
  for (std::size_t i = 0; i < values.size(); ++i) exact += std::abs(values[i] - wanted[i]) < 1e-9;
  EXPECT_GT(exact, values.size() * 9 / 10);
  EXPECT_THROW(carry_one(field, old, now, {.integration_points = "T"}), InputError);
  EXPECT_THROW(carry_one(of_elements(old, wave), old, now, {.integration_points = "f"}), InputError);
}

TEST(CarryFields, BodiesThatDifferKeepTheIntegralOrTheValues) {
  const TetMesh old = kuhn_cube(4);
  TetMesh now = kuhn_cube(5);
  for (Vec3& p : now.points) p.x *= 1.25;
  const MeshField field = of_elements(old, [](Vec3 p) { return p.y < 0.5 ? 1.0 : 3.0; });
  const CarriedFields spread = carry_one(field, old, now), kept = carry_one(field, old, now, {.keep_integrals = false});
  EXPECT_NEAR(spread.report.uncovered, 0.25, 1e-14);
  EXPECT_NEAR(spread.report.lost, 0, 1e-14);
  EXPECT_NEAR(spread.report.fields[0].after.integral[0], 2, 1e-14);
  EXPECT_EQ(spread.report.fields[0].beyond, 0);
  EXPECT_GE(spread.report.fields[0].after.least[0], 1);
  EXPECT_NEAR(kept.report.fields[0].after.integral[0], 2.5, 0.05);
  // What is new has the value of what is nearest.
  for (TetIndex t = 0; t < now.tets.size(); ++t)
    if (middle_in(now, t).y < 0.4) {
      EXPECT_EQ(kept.fields[0].values[t], 1);
    }
  const CarriedFields constant = carry_one(of_elements(old, [](Vec3) { return 1; }), old, now);
  EXPECT_NEAR(constant.report.fields[0].after.integral[0], 1, 1e-14);
  EXPECT_NEAR(constant.report.fields[0].beyond, 0.2, 1e-14);
  EXPECT_EQ(constant.report.notes.size(), 2u);
}

TEST(CarryFields, ComponentsGoByThemselvesOnAnyNumberOfThreads) {
  const TetMesh old = perturbed(kuhn_cube(5), 0.2, 1), now = perturbed(kuhn_cube(6), 0.2, 2);
  const MeshField one = of_elements(old, wave), other = of_elements(old, [](Vec3 p) { return p.x * 1e6; });
  MeshField both{"both", true, 2, {}};
  for (std::size_t t = 0; t < old.tets.size(); ++t)
    both.values.push_back(one.values[t]), both.values.push_back(other.values[t]);
  for (const bool linear : {false, true}) {
    const CarryOptions options{.linear_elements = linear};
    const std::vector<MeshField> fields{one, both, at_nodes(old, wave)};
    RunContext alone;
    alone.threads = 1;
    const CarriedFields made = carry_fields(fields, old, now, options),
                        again = carry_fields(fields, old, now, options, alone);
    const auto second = carry_one(other, old, now, options).fields[0].values;
    for (std::size_t f = 0; f < fields.size(); ++f) EXPECT_EQ(made.fields[f].values, again.fields[f].values);
    for (std::size_t t = 0; t < now.tets.size(); ++t) {
      EXPECT_EQ(made.fields[1].values[2 * t], made.fields[0].values[t]);
      EXPECT_EQ(made.fields[1].values[2 * t + 1], second[t]);
    }
  }
}

TEST(CarryFields, ImprovedMeshesKeepIntegrals) {
  const TetMesh old = perturbed(kuhn_cube(5), 0.35, 3);
  const Improved improved = improve_existing(old, {});
  const CarriedFields made = carry_one(of_elements(old, wave), old, improved.mesh);
  EXPECT_LT(made.report.fields[0].integral_error, 1e-14);
  EXPECT_LE(made.report.fields[0].after.greatest[0], made.report.fields[0].before.greatest[0]);
}

TEST(CarryFields, WhatCannotBeCarriedIsRefused) {
  const TetMesh old = kuhn_cube(2), now = kuhn_cube(3);
  EXPECT_THROW(carry_one({"u", false, 1, {1, 2}}, old, now), InputError);
  EXPECT_THROW(carry_one({"u", true, 0, {}}, old, now), InputError);
  MeshField bad = at_nodes(old, wave);
  bad.values[3] = std::numeric_limits<double>::infinity();
  EXPECT_THROW(carry_one(bad, old, now), InputError);
  TetMesh turned = now;
  std::swap(turned.tets[0][0], turned.tets[0][1]);
  EXPECT_THROW(carry_one(at_nodes(old, wave), old, turned), InputError);
  std::atomic<bool> stop{true};
  RunContext context;
  context.cancel = &stop;
  EXPECT_THROW(carry_fields(std::vector<MeshField>{at_nodes(old, wave)}, old, now, {}, context), Cancelled);
}

}  // namespace
}  // namespace octafront
