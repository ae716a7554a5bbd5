#include "base/mesh/renumber_mesh.h"

#include <gtest/gtest.h>

namespace octafront {
namespace {

TEST(DropUnusedPoints, ClosesTheGapsAndKeepsTheOrder) {
  TetMesh mesh;
  for (int i = 0; i < 8; ++i) mesh.points.push_back({double(i), 0, 0});
  mesh.tets = {{7, 2, 4, 5}};
  mesh.boundary = {{2, 4, 7}};
  drop_unused_points(mesh);
  EXPECT_EQ(mesh.points, (std::vector<Vec3>{{2, 0, 0}, {4, 0, 0}, {5, 0, 0}, {7, 0, 0}}));
  EXPECT_EQ(mesh.tets, (std::vector<Tet>{{3, 0, 1, 2}}));
  EXPECT_EQ(mesh.boundary, (std::vector<Triangle>{{0, 1, 3}}));
}

TEST(DropUnusedPoints, LeavesTheFirstWhereTheyAre) {
  TetMesh mesh;
  for (int i = 0; i < 8; ++i) mesh.points.push_back({double(i), 0, 0});
  mesh.tets = {{7, 2, 4, 5}};
  drop_unused_points(mesh, 3);
  EXPECT_EQ(mesh.points.size(), 6u);
  EXPECT_EQ(mesh.tets, (std::vector<Tet>{{5, 2, 3, 4}}));
}

TEST(RenumberVertices, KnowsWedgesAndQuadrilaterals) {
  TetMesh mesh;
  mesh.wide_cells = {{0, 2, {0, 1, 2, 3, 4, kNone}}};
  mesh.wide_faces = {{0, {3, 2, 1, 0}}};
  renumber_vertices(mesh, {5, 6, 7, 8, 9});
  EXPECT_EQ(mesh.wide_cells[0].nodes, (std::array<VertexIndex, 6>{5, 6, 7, 8, 9, kNone}));
  EXPECT_EQ(mesh.wide_faces[0].nodes, (std::array<VertexIndex, 4>{8, 7, 6, 5}));
}

}  // namespace
}  // namespace octafront
