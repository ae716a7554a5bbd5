// Flat elements all of whose corners lie on the surface get room.

#include "improve/schedule/raise_flat.h"

#include <octafront/quality.h>
#include <octafront/validity.h>

#include "base/core/stage.h"
#include "base/geometry/measures.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace octafront {
namespace {

/// An element between two edges that cross `height` apart, and two more above and below it: all corners are on the
/// surface.
TetMesh with_flat_element(double height) {
  TetMesh mesh;
  mesh.points = {{-1, 0, 0}, {1, 0, 0}, {0, -1, height}, {0, 1, height}, {0, 0, 1 + height}, {0, 0, -1}};
  mesh.tets = {{0, 1, 2, 3}, {0, 3, 2, 4}, {1, 2, 3, 4}, {0, 1, 3, 5}, {0, 2, 1, 5}};
  for (Tet& t : mesh.tets)
    if (signed_volume(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]) < 0)
      std::swap(t[0], t[1]);
  mesh.boundary = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {0, 5, 2}, {2, 5, 1}, {1, 5, 3}, {3, 5, 0}};
  return mesh;
}

SurfaceMesh surface_of(const TetMesh& mesh) {
  return {mesh.points, mesh.boundary, {}, {}, {}};
}

RaisedFlat raised(TetMesh& mesh, const SurfaceMesh& surface, double limit) {
  StageReport report;
  return raise_flat(mesh, surface, {limit, nullptr, nullptr, nullptr}, {no_context(), report});
}

double largest_move(const TetMesh& a, const TetMesh& b) {
  double largest = 0;
  for (std::size_t v = 0; v < a.points.size(); ++v) largest = std::max(largest, distance(a.points[v], b.points[v]));
  return largest;
}

TEST(RaiseFlat, GivesRoomToAnElementWithoutHeight) {
  const TetMesh before = with_flat_element(1e-9);
  TetMesh mesh = before;
  constexpr double kLimit = 0.25;
  const RaisedFlat result = raised(mesh, surface_of(before), kLimit);
  EXPECT_GT(result.vertices, 0u);
  EXPECT_GT(summarize_quality(mesh).beta_min, 0.2);
  EXPECT_EQ(first_defect(mesh), std::nullopt);
  EXPECT_LE(result.largest_move, kLimit);
  EXPECT_DOUBLE_EQ(result.largest_move, largest_move(before, mesh));
}

TEST(RaiseFlat, MovesNoFartherThanTheLimit) {
  const TetMesh before = with_flat_element(1e-9);
  TetMesh mesh = before;
  raised(mesh, surface_of(before), 0.01);
  EXPECT_GT(largest_move(before, mesh), 0);
  EXPECT_LE(largest_move(before, mesh), 0.01);
  EXPECT_EQ(first_defect(mesh), std::nullopt);
}

TEST(RaiseFlat, CornersThatStrayedBeforeGoNoFartherFromTheInput) {
  const TetMesh before = with_flat_element(1e-9);
  SurfaceMesh input = surface_of(before);
  for (Vec3& p : input.points) p.z += 0.2;
  const TriangleTree tree(input);
  const auto farthest = [&](const TetMesh& mesh) {
    double most = 0;
    for (int v = 0; v < 4; ++v) most = std::max(most, tree.nearest(mesh.points[v]).squared_distance);
    return std::sqrt(most);
  };
  const double had = farthest(before);
  const auto after = [&](const TriangleTree* held) {
    TetMesh mesh = before;
    StageReport report;
    RaiseLimits limits{0.25, nullptr, nullptr, nullptr, held, had};
    raise_flat(mesh, surface_of(before), limits, {no_context(), report});
    return farthest(mesh);
  };
  EXPECT_GT(after(nullptr), had);
  EXPECT_LE(after(&tree), had);
}

TEST(RaiseFlat, LeavesGoodElementsAlone) {
  TetMesh good = with_flat_element(0.7);
  EXPECT_EQ(raised(good, surface_of(good), 0.25).vertices, 0u);
}

TEST(RaiseFlat, CornersBetweenCurvesAreNoReasonToStayFlat) {
  const TetMesh before = [] {
    TetMesh mesh = with_flat_element(1e-9);
    mesh.points[0].x = -7;
    return mesh;
  }();
  const SurfaceMesh surface = surface_of(before);
  const TriangleTree tree(surface);
  const Features curves{{{0, 2}, {0, 3}}, {0}};  // 16 degrees apart
  const improve::BoundaryInput input{surface, tree, curves, curves};
  const improve::InputForce force(input);
  ASSERT_EQ(force.cause_at({-1.5, 0, 0}, 7), improve::InputForce::Cause::kCorner);
  TetMesh mesh = before;
  StageReport report;
  EXPECT_GT(raise_flat(mesh, surface, {0.25, nullptr, nullptr, &force}, {no_context(), report}).vertices, 0u);
  EXPECT_EQ(first_defect(mesh), std::nullopt);
}

}  // namespace
}  // namespace octafront
