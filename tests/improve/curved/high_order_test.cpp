#include <octafront/adapt.h>
#include <octafront/error.h>
#include <octafront/generate.h>
#include <octafront/improve_existing.h>
#include <octafront/run_context.h>
#include <octafront/second_order.h>
#include <octafront/validity.h>

#include "base/geometry/tet_lattice.h"
#include "base/mesh/quadratic_nodes.h"
#include "improve/curved/curved.h"
#include "support/complexes.h"
#include "support/named_surfaces.h"
#include "support/rich_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using testing::cube;
using testing::icosphere;
using testing::rich_mesh;

TetMesh ball(double size, int order, int levels = 4) {
  Options options;
  options.size.size = size;
  options.order = order;
  return generate(icosphere(levels), options).mesh;
}

/// Farthest node of the faces of the boundary from the unit sphere.
double farthest_high_node(const TetMesh& mesh) {
  std::set<Triangle> outside;
  for (Triangle t : mesh.boundary) {
    std::ranges::sort(t);
    outside.insert(t);
  }
  double most = 0;
  const TetLattice& lattice = tet_lattice(mesh.order());
  std::array<Vec3, 35> room;
  for (TetIndex t = 0; t < mesh.tets.size(); ++t) {
    const std::span<const Vec3> nodes = nodes_of_tet(mesh, t, room);
    for (std::size_t i = 0; i < 4; ++i) {
      Triangle face;
      for (std::size_t k = 0; k < 3; ++k) face[k] = mesh.tets[t][static_cast<std::size_t>(kTetFaces[i][k])];
      std::ranges::sort(face);
      if (!outside.contains(face)) continue;
      for (std::size_t n = 0; n < nodes.size(); ++n)
        if (lattice.weights(n)[i] == 0) most = std::max(most, std::abs(length(nodes[n]) - 1));
    }
  }
  return most;
}

TEST(HighOrder, BallsAreProvenAndTrue) {
  for (const int order : {3, 4}) {
    const TetMesh mesh = ball(0.5, order);
    EXPECT_EQ(mesh.order(), order);
    EXPECT_EQ(first_defect(mesh), std::nullopt);
    EXPECT_EQ(check_jacobians(mesh).invalid, 0u);
    EXPECT_GT(check_jacobians(mesh).least_scaled_jacobian, 0.1);
    EXPECT_LT(farthest_high_node(mesh), 2e-5) << order;
    EXPECT_NEAR(curved_volume(mesh) / (4 * std::numbers::pi / 3), 1, order == 3 ? 6e-4 : 4e-5) << order;
  }
}

TEST(HighOrder, ElementsShareTheNodesOfTheirEdgesAndFaces) {
  for (const int order : {3, 4}) {
    TetMesh mesh = ball(0.6, 1);
    const std::size_t corners = mesh.points.size();
    make_curved(mesh, order);
    // Euler: of a ball's mesh corners - edges + faces - tets is 1.
    const std::size_t faces = (4 * mesh.tets.size() + mesh.boundary.size()) / 2;
    const std::size_t edges = corners + faces - mesh.tets.size() - 1;
    EXPECT_EQ(mesh.points.size(), corners + edges * nodes_in_edge(order) + faces * nodes_in_face(order) +
                                      mesh.tets.size() * nodes_in_tet(order));
    EXPECT_EQ(first_defect(mesh), std::nullopt);
    const JacobianSummary found = check_jacobians(mesh);
    EXPECT_EQ(found.invalid, 0u);
    EXPECT_NEAR(found.least_scaled_jacobian, 1, 1e-9);
    TetMesh again = mesh;
    make_linear(again);
    EXPECT_EQ(again.points.size(), corners);
    EXPECT_EQ(again.order(), 1);
  }
}

TEST(HighOrder, ABallOfFewElementsIsEased) {
  TetMesh mesh = ball(1.2, 1);
  const SurfaceMesh surface = icosphere(4);
  const SecondOrderSummary made = make_curved(mesh, 4, &surface);
  EXPECT_EQ(check_jacobians(mesh).invalid, 0u);
  EXPECT_EQ(made.edges, made.curved + made.eased + made.straight);
  EXPECT_GT(made.curved, 0u);
}

TEST(HighOrder, ATorusOfFewElementsIsEasedAndProven) {
  Options options;
  for (const double size : {1.0, 0.6})
    for (const int order : {3, 4}) {
      options.size.size = size;
      options.order = order;
      const Result made = generate(testing::torus(64, 24), options);
      EXPECT_EQ(check_jacobians(made.mesh).invalid, 0u);
      EXPECT_GE(made.report.second_order.least_scaled_jacobian, 0.09) << size << " " << order;
      EXPECT_NEAR(made.report.volume / (2 * std::numbers::pi * std::numbers::pi * 0.35 * 0.35), 1, 0.05);
    }
}

TEST(HighOrder, VolumesOfRegionsAreThoseOfCurvedElements) {
  Options options;
  options.size.size = 0.4;
  for (const int order : {2, 3}) {
    options.order = order;
    const Report report = generate(testing::nested_shells(2).surface, options).report;
    ASSERT_EQ(report.regions.size(), 2u);
    EXPECT_NEAR(report.regions[0].volume + report.regions[1].volume, report.volume, 1e-12) << order;
  }
}

TEST(HighOrder, WhatIsNotForItIsRefused) {
  TetMesh mesh = ball(0.8, 1);
  EXPECT_THROW(make_curved(mesh, 5), OptionError);
  make_curved(mesh, 3);
  EXPECT_THROW(make_curved(mesh, 3), InputError);
  Options options;
  options.order = 3;
  options.adapt.only = "sphere:0,0,0,1";
  EXPECT_THROW(adapt_existing(mesh, options), OptionError);
}

TEST(HighOrder, AMovedNodeIsFound) {
  TetMesh mesh = ball(0.6, 3);
  const VertexIndex node = mesh.high_nodes[7 * mesh.high_nodes_per_tet()];
  mesh.points[node] += Vec3{3, 0, 0};
  const JacobianSummary found = check_jacobians(mesh);
  EXPECT_GT(found.invalid, 0u);
  EXPECT_TRUE(first_defect(mesh).has_value());
}

/// A ball in which an edge inside is bent through an element.
TetMesh spoilt_ball(int order) {
  TetMesh mesh = ball(0.5, order);
  std::set<VertexIndex> outside;
  for (const Triangle& t : mesh.boundary) outside.insert(t.begin(), t.end());
  for (TetIndex t = 0; t < mesh.tets.size(); ++t) {
    if (outside.contains(mesh.tets[t][0])) continue;
    const VertexIndex node = order == 2 ? mesh.mid_nodes[t][0] : mesh.high_nodes[t * mesh.high_nodes_per_tet()];
    mesh.points[node] += 0.9 * (mesh.points[mesh.tets[t][3]] - mesh.points[node]);
    break;
  }
  return mesh;
}

TEST(HighOrder, ImprovementMendsAndKeepsWalls) {
  for (const int order : {2, 3, 4}) {
    const TetMesh spoilt = spoilt_ball(order);
    EXPECT_GT(check_jacobians(spoilt).invalid, 0u);
    Options options;
    options.order = order;
    const TetMesh mended = improve_existing(spoilt, options).mesh;
    EXPECT_EQ(mended.order(), order);
    EXPECT_EQ(first_defect(mended), std::nullopt);
    EXPECT_EQ(check_jacobians(mended).invalid, 0u);
    EXPECT_NEAR(curved_volume(mended), curved_volume(ball(0.5, order)), 1e-2 * std::pow(0.2, order));
  }
}

TEST(HighOrder, AdaptedMeshesAreCurvedAlongTheirWalls) {
  const TetMesh before = ball(0.5, 3);
  Options options;
  options.size.size = 0.35;
  for (const int order : {1, 2, 4}) {
    options.order = order;
    const AdaptedMesh adapted = adapt_existing(before, options);
    EXPECT_EQ(adapted.mesh.order(), order);
    EXPECT_GT(adapted.mesh.tets.size(), before.tets.size());
    EXPECT_EQ(first_defect(adapted.mesh), std::nullopt);
    EXPECT_EQ(check_jacobians(adapted.mesh).invalid, 0u);
    EXPECT_EQ(adapted.old_of_new.size(), adapted.mesh.points.size());
    EXPECT_NEAR(curved_volume(adapted.mesh) / (4 * std::numbers::pi / 3), 1, order == 1 ? 0.06 : 1e-3) << order;
  }
}

TEST(HighOrder, ImprovementChangesOrders) {
  const TetMesh quadratic = ball(0.5, 2);
  Options options;
  options.order = 4;
  const TetMesh quartic = improve_existing(quadratic, options).mesh;
  EXPECT_EQ(quartic.order(), 4);
  // The walls are the same polynomials.
  EXPECT_NEAR(curved_volume(quartic), curved_volume(quadratic), 1e-12);
  options.order = 1;
  EXPECT_EQ(improve_existing(quadratic, options).mesh.order(), 1);
}

}  // namespace
}  // namespace octafront
