#include "improve/curved/easing.h"

#include <octafront/run_context.h>
#include <octafront/validity.h>

#include "support/rich_mesh.h"

#include <gtest/gtest.h>

namespace octafront::curved {
namespace {

using octafront::testing::rich_mesh;

/// The tetrahedron (0,0,0) (1,0,0) (0,1,0) (0,0,1).
TetMesh corner() {
  TetMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.tets = {{0, 1, 2, 3}};
  mesh.boundary = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  return mesh;
}

SecondOrderSummary bend(TetMesh& mesh, std::vector<EdgeBend> bends) {
  SecondOrderSummary summary;
  const TetEdges edges = add_straight_mid_nodes(mesh);
  bend_edges(mesh, edges, bends, summary, no_context());
  return summary;
}

TEST(MidNodes, EachEdgeHasOneInItsMiddle) {
  TetMesh mesh = rich_mesh(4);
  const std::size_t corners = mesh.points.size();
  const TetEdges edges = add_straight_mid_nodes(mesh);
  EXPECT_EQ(mesh.points.size(), corners + edges.size());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (std::size_t e = 0; e < 6; ++e) {
      const VertexIndex a = mesh.tets[t][static_cast<std::size_t>(kTetEdges[e][0])],
                        b = mesh.tets[t][static_cast<std::size_t>(kTetEdges[e][1])];
      EXPECT_EQ(mesh.mid_nodes[t][e], corners + edges.find(b, a));
      EXPECT_EQ(mesh.points[mesh.mid_nodes[t][e]], 0.5 * (mesh.points[a] + mesh.points[b]));
    }
  EXPECT_EQ(edges.find(0, static_cast<VertexIndex>(corners - 1)), kNone);
  for (NamedSet& set : mesh.sets) set.members.clear();
  EXPECT_EQ(first_defect(mesh), std::nullopt);
}

TEST(Easing, WhatIsValidBendsAllTheWay) {
  TetMesh mesh = corner();
  const SecondOrderSummary made = bend(mesh, {{{1, 2}, {0.1, 0.1, 0}}, {{2, 3}, {0, 0.1, 0.1}}});
  EXPECT_EQ(made.curved, 2u);
  EXPECT_EQ(made.eased, 0u);
  EXPECT_EQ(made.straight, 4u);
  EXPECT_EQ(mesh.points[mesh.mid_nodes[0][3]], (Vec3{0.6, 0.6, 0}));
  EXPECT_EQ(first_defect(mesh), std::nullopt);
}

TEST(Easing, TheEdgeThatBendsMostGivesWayByHalves) {
  TetMesh mesh = corner();
  // 0.4 along the edge 01 puts its node past three quarters, which is not valid; half of it is.
  const SecondOrderSummary made = bend(mesh, {{{0, 1}, {0.4, 0, 0}}, {{1, 2}, {0.05, 0.05, 0}}});
  EXPECT_EQ(made.curved, 1u);
  EXPECT_EQ(made.eased, 1u);
  EXPECT_EQ(mesh.points[mesh.mid_nodes[0][0]], (Vec3{0.7, 0, 0}));
  EXPECT_EQ(mesh.points[mesh.mid_nodes[0][3]], (Vec3{0.55, 0.55, 0}));
  EXPECT_EQ(first_defect(mesh), std::nullopt);
}

TEST(Easing, WhatCannotBeIsStraightInTheEnd) {
  TetMesh mesh = corner();
  const SecondOrderSummary made = bend(mesh, {{{0, 1}, {0, 0, 1e6}}});
  EXPECT_EQ(made.eased, 1u);
  EXPECT_EQ(mesh.points[mesh.mid_nodes[0][0]], (Vec3{0.5, 0, 0}));
  EXPECT_EQ(made.largest_bend, 0);
  EXPECT_EQ(first_defect(mesh), std::nullopt);
}

TEST(Easing, NeighboursAreAskedToo) {
  // Two tetrahedra on one face: what suits one of them is not valid for the other.
  TetMesh mesh = corner();
  mesh.points.push_back({1, 1, 1});
  mesh.tets.push_back({1, 2, 3, 4});
  mesh.boundary = {{0, 3, 2}, {0, 1, 3}, {0, 2, 1}, {4, 2, 3}, {4, 3, 1}, {4, 1, 2}};
  const std::vector<EdgeBend> outward{{{1, 2}, {0.6, 0.6, 0.9}}};
  TetMesh alone = corner();
  EXPECT_EQ(bend(alone, outward).eased, 0u);
  EXPECT_EQ(bend(mesh, outward).eased, 1u);
  EXPECT_EQ(first_defect(mesh), std::nullopt);
}

TEST(Easing, CornersKeepHalfOfEachVolume) {
  TetMesh mesh = corner();
  SecondOrderSummary made;
  const std::vector<CornerMove> moves{{3, {0, 0, -0.8}}};
  move_corners(mesh, moves, made, no_context());
  EXPECT_EQ(mesh.points[3], (Vec3{0, 0, 0.6}));  // halfway
  EXPECT_EQ(made.held, 1u);
  EXPECT_EQ(made.moved, 0u);
}

TEST(Easing, CornersThatMaySayWhereTheyWant) {
  TetMesh mesh = corner();
  SecondOrderSummary made;
  const std::vector<CornerMove> moves{{1, {0.1, 0, 0}}, {3, {0, 0, 0.2}}};
  move_corners(mesh, moves, made, no_context());
  EXPECT_EQ(mesh.points[1], (Vec3{1.1, 0, 0}));
  EXPECT_EQ(mesh.points[3], (Vec3{0, 0, 1.2}));
  EXPECT_EQ(made.moved, 2u);
}

}  // namespace
}  // namespace octafront::curved
