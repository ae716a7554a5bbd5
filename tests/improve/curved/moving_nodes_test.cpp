#include "improve/curved/moving_nodes.h"

#include <octafront/generate.h>
#include <octafront/run_context.h>
#include <octafront/second_order.h>

#include "base/geometry/curved_tet.h"
#include "base/geometry/measures.h"
#include "base/mesh/known_surface.h"
#include "base/mesh/quadratic_nodes.h"
#include "improve/curved/bent_nodes.h"
#include "improve/curved/easing.h"
#include "improve/curved/smooth_surface.h"
#include "support/named_surfaces.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace octafront::curved {
namespace {

constexpr double kRadius = 0.5;  // of the hollow in a ball

TetMesh linear_ball() {
  Options options;
  options.size.size = 0.3;
  return generate(testing::hollow_sphere(4), options).mesh;
}

/// One vertex inside comes so near to a face of the hollow that this bends nearly up to it.
TetMesh ball_with_flat_element() {
  TetMesh mesh = linear_ball();
  for (const Tet& tet : mesh.tets)
    for (std::size_t i = 0; i < 4; ++i) {
      const auto on_sphere = [&](VertexIndex v) { return std::abs(length(mesh.points[v]) - kRadius) < 0.01; };
      if (on_sphere(tet[i]) || std::ranges::count_if(tet, on_sphere) < 3) continue;
      Vec3 middle;
      for (std::size_t k = 0; k < 4; ++k)
        if (k != i) middle += mesh.points[tet[k]] / 3;
      mesh.points[tet[i]] = 0.9 * middle + 0.1 * mesh.points[tet[i]];
      return mesh;
    }
  return mesh;
}

BentNodes bent_ball(TetMesh& mesh, int order) {
  const SurfaceMesh surface = testing::hollow_sphere(4);
  const KnownSurface known(surface, 40);
  SmoothSurface smooth(surface, known.edges(), known.tree(), known.features());
  return BentNodes(mesh, order, find_bends(mesh, {}, smooth, order));
}

NodesMoved moved_for_shape(TetMesh& mesh, const BentNodes& nodes, Walls walls) {
  std::vector<TetIndex> all(mesh.tets.size());
  std::iota(all.begin(), all.end(), 0);
  return raise_worst_elements(mesh, all, kLeastScaledJacobian, nodes.is_on_wall(), walls, no_context());
}

std::vector<double> shapes_of(const TetMesh& mesh) {
  std::vector<double> shapes;
  std::array<Vec3, 35> room;
  for (TetIndex t = 0; t < mesh.tets.size(); ++t) {
    const JacobianRange range = jacobian_range(mesh.order(), nodes_of_tet(mesh, t, room));
    shapes.push_back(range.least / range.straight);
  }
  return shapes;
}

/// Of shapes, as far as they matter.
double sum_of_bad(const std::vector<double>& shapes) {
  double sum = 0;
  for (const double shape : shapes) sum += std::min(shape, kLeastScaledJacobian);
  return sum;
}

TEST(MovingNodes, ThoseOfWallsSlideAlongThemForBetterElements) {
  for (const int order : {3, 4}) {
    TetMesh mesh = ball_with_flat_element();
    const BentNodes nodes = bent_ball(mesh, order);
    const TetMesh before = mesh;
    const std::vector<double> were = shapes_of(mesh);
    ASSERT_LT(*std::ranges::min_element(were), kLeastScaledJacobian);
    const NodesMoved moved = moved_for_shape(mesh, nodes, Walls::kSlide);
    ASSERT_FALSE(moved.slid.empty()) << order;
    std::set<VertexIndex> known;
    for (const auto& [node, by] : moved.by) known.insert(node);
    for (VertexIndex v = 0; v < mesh.points.size(); ++v)
      EXPECT_EQ(mesh.points[v] != before.points[v], known.contains(v)) << v;
    for (const SlidNode& slid : moved.slid) {
      EXPECT_NE(mesh.points[slid.node], before.points[slid.node]);
      EXPECT_NEAR(length(mesh.points[slid.node]), kRadius, 2e-3) << "still on the wall";
    }
    const std::vector<double> are = shapes_of(mesh);
    for (std::size_t t = 0; t < are.size(); ++t) EXPECT_GE(are[t], std::min(were[t], kLeastScaledJacobian)) << t;
    EXPECT_GT(sum_of_bad(are), sum_of_bad(were));

    TetMesh held = before;
    EXPECT_TRUE(moved_for_shape(held, nodes, Walls::kStay).slid.empty());
    const double without = sum_of_bad(shapes_of(held));
    moved_for_shape(held, nodes, Walls::kSlide);
    EXPECT_GT(sum_of_bad(shapes_of(held)), without);
  }
}

TEST(MovingNodes, OrderFourGoesOnFromWhereOrderThreeEnded) {
  TetMesh high = linear_ball(), low = high;
  BentNodes fourth = bent_ball(high, 4);
  const TetMesh at_first = high;
  BentNodes third(low, 3, fourth.lowered());
  fourth.go_on_from(third);
  // Nothing slid and nothing was eased: what bends is where it was.
  const auto expect_unmoved = [&](VertexIndex v) {
    EXPECT_LT(distance(high.points[v], at_first.points[v]), 1e-14) << v;
  };
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::uint32_t e = 0; e < fourth.edges().size(); ++e)
      if (fourth.bent_of_edge(e) != kNone) expect_unmoved(fourth.node_in_edge(e, k));
    for (std::uint32_t f = 0; f < fourth.faces().corners.size(); ++f)
      if (fourth.bent_of_face(f) != kNone) expect_unmoved(fourth.node_in_face(f, k));
  }

  // An edge that is straight at order 3 is so at order 4.
  std::uint32_t e = 0;
  while (third.bent_of_edge(e) == kNone) ++e;
  third.bents()[third.bent_of_edge(e)].halvings = kMostHalvings;
  third.place_all();
  TetMesh again = linear_ball();
  BentNodes eased = bent_ball(again, 4);
  eased.go_on_from(third);
  EXPECT_TRUE(eased.bents()[eased.bent_of_edge(e)].is_eased());
  for (std::size_t k = 0; k < 3; ++k) EXPECT_LT(length(eased.off_edge(e, k)), 1e-14);
}

TEST(MovingNodes, WhatSlidAtOrderThreeLiesBetweenAtOrderFour) {
  TetMesh high = ball_with_flat_element(), low = high;
  BentNodes fourth = bent_ball(high, 4);
  BentNodes third(low, 3, fourth.lowered());
  const NodesMoved moved = moved_for_shape(low, third, Walls::kSlide);
  ASSERT_FALSE(moved.slid.empty());
  third.take(moved);
  fourth.go_on_from(third);
  double farthest = 0, moved_most = 0;
  const BentNodes unmoved = bent_ball(low = ball_with_flat_element(), 4);
  for (std::uint32_t e = 0; e < fourth.edges().size(); ++e) {
    if (fourth.bent_of_edge(e) == kNone) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const VertexIndex node = fourth.node_in_edge(e, k);
      if (length(high.points[node]) > 0.75) continue;
      farthest = std::max(farthest, std::abs(length(high.points[node]) - kRadius));
      moved_most = std::max(moved_most, distance(high.points[node], low.points[node]));
    }
  }
  EXPECT_LT(farthest, 2e-3) << "they are on the wall";
  EXPECT_GT(moved_most, 0.01) << "and go along";
}

}  // namespace
}  // namespace octafront::curved
