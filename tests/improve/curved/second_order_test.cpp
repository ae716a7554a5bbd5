#include <octafront/error.h>
#include <octafront/generate.h>
#include <octafront/improve_existing.h>
#include <octafront/run_context.h>
#include <octafront/second_order.h>
#include <octafront/validity.h>

#include "support/named_surfaces.h"
#include "support/rich_mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using testing::cube;
using testing::icosphere;
using testing::rich_mesh;
using testing::torus;

Options options_of(double size, int order) {
  Options options;
  options.size.size = size;
  options.order = order;
  return options;
}

/// Farthest mid-side node of the boundary's edges from the unit ball; corners too.
double farthest_from_ball(const TetMesh& mesh) {
  double most = 0;
  std::vector<bool> outside(mesh.points.size());
  for (const Triangle& t : mesh.boundary)
    for (const VertexIndex v : t) outside[v] = true;
  const auto look = [&](VertexIndex v) { most = std::max(most, std::abs(length(mesh.points[v]) - 1)); };
  for (VertexIndex v = 0; v < mesh.points.size(); ++v)
    if (outside[v]) look(v);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (int i = 0; i < 4; ++i) {
      const auto& f = kTetFaces[static_cast<std::size_t>(i)];
      Triangle face;
      for (std::size_t k = 0; k < 3; ++k) face[k] = mesh.tets[t][static_cast<std::size_t>(f[k])];
      std::sort(face.begin(), face.end());
      const bool on_boundary = std::any_of(mesh.boundary.begin(), mesh.boundary.end(), [&](Triangle b) {
        std::sort(b.begin(), b.end());
        return b == face;
      });
      if (!on_boundary) continue;
      for (std::size_t e = 0; e < 6; ++e)
        if (kTetEdges[e][0] != i && kTetEdges[e][1] != i) look(mesh.mid_nodes[t][e]);
    }
  return most;
}

TEST(SecondOrder, ABallIsRound) {
  const Result made = generate(icosphere(5), options_of(0.3, 2));
  EXPECT_EQ(first_defect(made.mesh), std::nullopt);
  const SecondOrderSummary& s = made.report.second_order;
  EXPECT_GT(s.curved, 400u);
  EXPECT_EQ(s.eased, 0u);
  EXPECT_EQ(s.edges, s.curved + s.eased + s.straight);
  EXPECT_EQ(made.mesh.points.size(), made.report.points);
  EXPECT_LT(farthest_from_ball(made.mesh), 2e-6);
  // Straight, the ball of this size lacks 3 % of its volume.
  EXPECT_NEAR(made.report.volume, 4 * std::numbers::pi / 3, 2e-4 * made.report.volume);
  EXPECT_GT(s.least_scaled_jacobian, 0.5);
}

TEST(SecondOrder, ACoarseBallIsRoundEvenIfTheMeshIsFiner) {
  const Result made = generate(icosphere(2), options_of(0.12, 2));
  EXPECT_EQ(first_defect(made.mesh), std::nullopt);
  EXPECT_NEAR(made.report.volume, 4 * std::numbers::pi / 3, 2e-3 * made.report.volume);
  EXPECT_LT(farthest_from_ball(made.mesh), 2e-3);  // the triangles of the input are .02 off
}

TEST(SecondOrder, FlatSidesStayStraight) {
  const Result made = generate(cube(3), options_of(0.2, 2));
  EXPECT_EQ(first_defect(made.mesh), std::nullopt);
  EXPECT_EQ(made.report.second_order.curved, 0u);
  EXPECT_EQ(made.report.second_order.moved, 0u);
  EXPECT_EQ(made.report.second_order.largest_bend, 0);
}

TEST(SecondOrder, KeptTrianglesStayStraight) {
  Options options;
  options.order = 2;
  options.surface.keep = true;
  const SurfaceMesh ball = icosphere(2);
  const Result made = generate(ball, options);
  EXPECT_EQ(first_defect(made.mesh, ball), std::nullopt);
  EXPECT_EQ(made.report.second_order.straight, made.report.second_order.edges);
}

TEST(SecondOrder, TheSameBitsForAnyNumberOfThreads) {
  RunContext one, many;
  one.threads = 1;
  many.threads = 4;
  const SurfaceMesh input = torus(64, 24);
  const Result a = generate(input, options_of(0.15, 2), one), b = generate(input, options_of(0.15, 2), many);
  EXPECT_EQ(a.mesh, b.mesh);
  EXPECT_EQ(a.report.second_order, b.report.second_order);
}

TEST(SecondOrder, PatchesOfASmoothSurfaceDoNotMakeEdges) {
  SurfaceMesh ball = icosphere(4);
  ball.patch.resize(ball.triangles.size());
  for (std::size_t t = 0; t < ball.triangles.size(); ++t)
    ball.patch[t] = ball.points[ball.triangles[t][0]].z + ball.points[ball.triangles[t][1]].z > 0 ? 1 : 0;
  ball.patch_names = {"south", "north"};
  const Result made = generate(ball, options_of(0.3, 2));
  EXPECT_EQ(first_defect(made.mesh), std::nullopt);
  EXPECT_LT(farthest_from_ball(made.mesh), 2e-5);
}

TEST(SecondOrder, ExistingMeshesAreCurvedToTheirSurface) {
  const SurfaceMesh ball = icosphere(4);
  TetMesh mesh = generate(ball, options_of(0.3, 1)).mesh;
  TetMesh straight = mesh;
  const SecondOrderSummary flat = make_second_order(straight);
  EXPECT_EQ(flat.straight, flat.edges);
  EXPECT_GT(farthest_from_ball(straight), 5e-3);
  const SecondOrderSummary curved = make_second_order(mesh, &ball);
  EXPECT_GT(curved.curved, 400u);
  EXPECT_LT(farthest_from_ball(mesh), 2e-5);
  EXPECT_EQ(first_defect(mesh), std::nullopt);
  EXPECT_THROW(make_second_order(mesh), InputError);
}

TEST(SecondOrder, ImprovementTakesMeshesUpAndDown) {
  const SurfaceMesh ball = icosphere(4);
  Options options = options_of(0.3, 2);
  const TetMesh linear = generate(ball, options_of(0.3, 1)).mesh, curved = generate(ball, options).mesh;
  const Improved up = improve_existing(linear, options, &ball);
  EXPECT_TRUE(up.mesh.is_second_order());
  EXPECT_EQ(first_defect(up.mesh), std::nullopt);
  EXPECT_LT(farthest_from_ball(up.mesh), 2e-5);
  options.order = 1;
  const Improved down = improve_existing(curved, options);
  EXPECT_FALSE(down.mesh.is_second_order());
  EXPECT_EQ(first_defect(down.mesh), std::nullopt);
}

TEST(SecondOrder, GoingUpAndDownChangesNothing) {
  const TetMesh before = rich_mesh(4);
  TetMesh mesh = before;
  make_second_order(mesh);
  EXPECT_EQ(first_defect(mesh), std::nullopt);
  make_linear(mesh);
  EXPECT_EQ(mesh, before);
}

TEST(SecondOrder, InvalidElementsAreNamed) {
  TetMesh mesh = rich_mesh(2);
  make_second_order(mesh);
  EXPECT_EQ(check_jacobians(mesh).invalid, 0u);
  const VertexIndex moved = mesh.mid_nodes[5][2];
  mesh.points[moved] += {0.6, 0.3, 0.2};
  const JacobianSummary found = check_jacobians(mesh);
  EXPECT_GT(found.invalid, 0u);
  EXPECT_LE(found.least_scaled_jacobian, 0);
  for (const InvalidElement& e : found.first) {
    const auto& mids = mesh.mid_nodes[e.tet];
    EXPECT_NE(std::find(mids.begin(), mids.end(), moved), mids.end());
  }
  ASSERT_TRUE(first_defect(mesh));
  EXPECT_NE(first_defect(mesh)->find("Jacobian"), std::string::npos);
}

TEST(SecondOrder, OnlyOrdersFromOneToFour) {
  Options options;
  options.order = 5;
  EXPECT_THROW(check_options(options), OptionError);
}

}  // namespace
}  // namespace octafront
