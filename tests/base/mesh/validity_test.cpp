#include <octafront/validity.h>

#include "base/core/renumber.h"
#include "base/mesh/edge_nodes.h"
#include "base/mesh/tet_meshes.h"
#include "support/lattice_points.h"
#include "support/rich_mesh.h"

#include <algorithm>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace octafront {
namespace {

using ::testing::HasSubstr;

SurfaceMesh surface_of(const TetMesh& mesh) {
  return {mesh.points, mesh.boundary, {}, {}, {}};
}

std::string defect(const TetMesh& mesh) {
  return first_defect(mesh).value_or("none");
}

TEST(FirstDefect, FindsNoneInValidMeshes) {
  EXPECT_THAT(defect({}), HasSubstr("no tetrahedra"));
  for (const int n : {1, 2, 5}) {
    TetMesh mesh = testing::tet_cube(n);
    EXPECT_EQ(defect(mesh), "none");
    EXPECT_EQ(first_defect(mesh, surface_of(mesh)), std::nullopt);
    for (Vec3& p : mesh.points) p = p * 0.1 + Vec3{1e6, -2e6, 3e5};
    EXPECT_EQ(defect(mesh), "none");
  }
}

TEST(FirstDefect, NamesTheTetThatIsFlatOrInverted) {
  TetMesh mesh = testing::tet_cube(2);
  std::swap(mesh.tets[17][1], mesh.tets[17][2]);
  EXPECT_THAT(defect(mesh), HasSubstr("tetrahedron 17 is inverted"));
  mesh = testing::tet_cube(1);
  mesh.tets[3][0] = mesh.tets[3][1];
  EXPECT_THAT(defect(mesh), HasSubstr("tetrahedron 3 is flat"));
}

TEST(FirstDefect, NamesBadIndicesAndVertices) {
  TetMesh mesh = testing::tet_cube(1);
  mesh.tets[2][1] = 8;
  EXPECT_THAT(defect(mesh), HasSubstr("tetrahedron 2 refers to vertex 8"));
  mesh = testing::tet_cube(1);
  mesh.boundary[4][0] = kNone;
  EXPECT_THAT(defect(mesh), HasSubstr("boundary face 4 refers to vertex"));
  mesh = testing::tet_cube(1);
  mesh.points.push_back({9, 9, 9});
  EXPECT_THAT(defect(mesh), HasSubstr("vertex 8 (9, 9, 9) belongs to no tetrahedron"));
  mesh = testing::tet_cube(1);
  mesh.points[3].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(defect(mesh), HasSubstr("vertex 3 (0, nan, 1) is not finite"));
  mesh = testing::tet_cube(1);
  mesh.patch.assign(3, 0);
  EXPECT_THAT(defect(mesh), HasSubstr("patch has 3 entries for 12"));
}

TEST(FirstDefect, NamesBadBoundaries) {
  const TetMesh good = testing::tet_cube(2);
  TetMesh mesh = good;
  mesh.boundary.erase(mesh.boundary.begin() + 7);
  EXPECT_THAT(defect(mesh), HasSubstr("is open but not listed as boundary"));
  mesh = good;
  std::swap(mesh.boundary[9][0], mesh.boundary[9][2]);
  EXPECT_THAT(defect(mesh), HasSubstr("boundary face 9 faces inward"));
  mesh = good;
  mesh.boundary.push_back(mesh.boundary[5]);
  EXPECT_THAT(defect(mesh), HasSubstr("tetrahedron 5, boundary face 5 and boundary face 48"));
  mesh = good;
  mesh.boundary.push_back({0, 13, 26});
  EXPECT_THAT(defect(mesh), HasSubstr("boundary face 48 but belongs to no tetrahedron"));
}

TEST(FirstDefect, NamesFacesOfTooManyTetsAndFoldedOnes) {
  TetMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.2, 0.2, 2}, {0.2, 0.2, -1}};
  mesh.tets = {{0, 1, 2, 3}, {0, 1, 2, 4}, {0, 2, 1, 5}};
  EXPECT_THAT(defect(mesh), HasSubstr("belongs to tetrahedron 0, tetrahedron 1 and tetrahedron 2"));
  mesh.tets.pop_back();
  mesh.points.pop_back();
  EXPECT_THAT(defect(mesh), HasSubstr("tetrahedron 0 and tetrahedron 1 lie on the same side"));
}

TEST(FirstDefect, KnowsInterfacesCurvesAndSets) {
  const TetMesh good = testing::rich_mesh(4);
  EXPECT_EQ(good.interfaces.size(), 32U);
  EXPECT_EQ(good.curve_edges.size(), 48U);
  EXPECT_EQ(defect(good), "none");
  TetMesh mesh = good;
  std::swap(mesh.interfaces[3][0], mesh.interfaces[3][1]);
  EXPECT_EQ(defect(mesh), "none");
  mesh.interfaces[4] = mesh.interfaces[3];
  EXPECT_THAT(defect(mesh), HasSubstr("and interface 4"));
  mesh = good;
  mesh.interfaces[2] = mesh.boundary[5];
  EXPECT_THAT(defect(mesh), HasSubstr("interface 2"));
  mesh = good;
  mesh.interfaces[2] = {0, 1, 2};
  EXPECT_THAT(defect(mesh), HasSubstr("interface 2 but belongs to no tetrahedron"));
  mesh = good;
  mesh.boundary.push_back(mesh.interfaces[0]);
  mesh.patch.push_back(0);
  EXPECT_NE(defect(mesh), "none");
  mesh = good;
  mesh.curve_edges[7] = {0, 2};
  EXPECT_THAT(defect(mesh), HasSubstr("curve edge 0 2"));
  mesh = good;
  mesh.sets[3].members = {2, 1};
  EXPECT_THAT(defect(mesh), HasSubstr("set core are not ascending"));
  mesh.sets[3].members = {4000};
  EXPECT_THAT(defect(mesh), HasSubstr("member 4000"));
}

TEST(FirstDefect, KnowsMidNodes) {
  const TetMesh good = testing::with_mid_nodes(testing::rich_mesh(2));
  EXPECT_EQ(defect(good), "none");
  TetMesh mesh = good;
  mesh.mid_nodes.pop_back();
  EXPECT_THAT(defect(mesh), HasSubstr("mid_nodes has 47 entries for 48"));
  mesh = good;
  mesh.mid_nodes[5][2] = 3;
  EXPECT_THAT(defect(mesh), HasSubstr("is not behind all corners"));
  mesh = good;
  std::swap(mesh.mid_nodes[5][2], mesh.mid_nodes[5][3]);
  EXPECT_THAT(defect(mesh), HasSubstr("is on two edges"));
  mesh = good;
  mesh.points.push_back({0.5, 0.5, 0.5});
  EXPECT_THAT(defect(mesh), HasSubstr("belongs to no tetrahedron"));
  mesh.mid_nodes[7][0] = static_cast<VertexIndex>(mesh.points.size() - 1);
  EXPECT_THAT(defect(mesh), HasSubstr("several mid-side nodes"));
}

TEST(EdgeNodes, AreThoseOfTheTets) {
  const TetMesh mesh = testing::with_mid_nodes(testing::rich_mesh(2));
  const EdgeNodes nodes(mesh);
  const auto middle = [&](VertexIndex a, VertexIndex b) { return (mesh.points[a] + mesh.points[b]) / 2; };
  for (const Triangle& t : mesh.boundary) {
    const Triangle mids = nodes.of(t);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(mesh.points[mids[i]], middle(t[i], t[(i + 1) % 3]));
  }
  for (const auto& [a, b] : mesh.curve_edges) EXPECT_EQ(mesh.points[nodes(b, a)], middle(a, b));
  EXPECT_EQ(nodes(0, 2), kNone);
  EXPECT_EQ(EdgeNodes(testing::rich_mesh(2))(0, 1), kNone);
}

TEST(Renumber, KeepsAllOfARichMesh) {
  TetMesh mesh = testing::with_mid_nodes(testing::rich_mesh(2));
  const TetMesh good = mesh;
  // A point that nothing uses, before all others.
  std::vector<VertexIndex> up(mesh.points.size());
  for (VertexIndex v = 0; v < up.size(); ++v) up[v] = v + 1;
  mesh.points.insert(mesh.points.begin(), Vec3{7, 7, 7});
  renumber_vertices(mesh, up);
  mesh.sets[0].members.insert(mesh.sets[0].members.begin(), 0);
  drop_unused_points(mesh);
  EXPECT_EQ(mesh, good);
}

TEST(FirstDefect, ComparesTheBoundaryWithTheSurface) {
  const TetMesh mesh = testing::tet_cube(2);
  SurfaceMesh surface = surface_of(mesh);
  // Numbering, order and rotation are free.
  std::reverse(surface.points.begin(), surface.points.end());
  for (Triangle& t : surface.triangles) {
    for (VertexIndex& v : t) v = static_cast<VertexIndex>(surface.points.size() - 1 - v);
    std::rotate(t.begin(), t.begin() + 1, t.end());
  }
  std::rotate(surface.triangles.begin(), surface.triangles.begin() + 11, surface.triangles.end());
  EXPECT_EQ(first_defect(mesh, surface), std::nullopt);

  SurfaceMesh other = surface;
  std::swap(other.triangles[4][0], other.triangles[4][1]);
  EXPECT_TRUE(first_defect(mesh, other).has_value());
  other = surface;
  other.points[surface.triangles[4][1]].x += 1e-16 + 1e-15;
  EXPECT_TRUE(first_defect(mesh, other).has_value());
  other.triangles[4][2] = 99;
  EXPECT_THAT(first_defect(mesh, other).value_or(""), HasSubstr("no vertex 99"));
  other = surface;
  other.triangles.pop_back();
  EXPECT_THAT(first_defect(mesh, other).value_or(""), HasSubstr("has a triangle that the surface has not"));
  other.triangles = surface.triangles;
  other.triangles.push_back(surface.triangles[3]);
  EXPECT_THAT(first_defect(mesh, other).value_or(""), HasSubstr("lacks the surface's triangle"));
}

RC_GTEST_PROP(FirstDefect, SeesAnyChangeOfAnyTet, ()) {
  static const TetMesh good = testing::tet_cube(2);
  TetMesh mesh = good;
  const auto t = *rc::gen::resize(100, rc::gen::inRange<std::size_t>(0, mesh.tets.size()));
  const auto corner = *rc::gen::inRange<std::size_t>(0, 4);
  const auto v = *rc::gen::resize(100, rc::gen::inRange<VertexIndex>(0, 27));
  RC_PRE(mesh.tets[t][corner] != v);
  mesh.tets[t][corner] = v;
  RC_ASSERT(first_defect(mesh).has_value());
}

RC_GTEST_PROP(FirstDefect, DoesNotCareForOrder, ()) {
  TetMesh mesh = testing::tet_cube(2);
  for (std::size_t i = 0; i < mesh.tets.size(); ++i)
    std::swap(mesh.tets[i], mesh.tets[*rc::gen::resize(100, rc::gen::inRange<std::size_t>(0, mesh.tets.size()))]);
  std::reverse(mesh.boundary.begin(), mesh.boundary.end());
  RC_ASSERT(!first_defect(mesh).has_value());
}

}  // namespace
}  // namespace octafront
