#include "mesh/surface_topology.h"

#include "support/named_surfaces.h"

#include <gtest/gtest.h>

namespace octafront {
namespace {

Shells shells_of(const SurfaceMesh& s) {
  return find_shells(s.triangles, half_edge_twins(s.triangles, s.points.size()), s.points.size());
}

bool closed_manifold(const SurfaceMesh& s) {
  return is_closed_manifold(s.triangles, s.points.size());
}

TEST(HalfEdgeTwins, RunTheOtherWay) {
  const SurfaceMesh s = testing::torus(7, 5);
  const auto twin = half_edge_twins(s.triangles, s.points.size());
  for (HalfEdge h = 0; h < twin.size(); ++h) {
    ASSERT_NE(twin[h], kNone);
    EXPECT_EQ(twin[twin[h]], h);
    EXPECT_EQ(start_of(s.triangles, h), end_of(s.triangles, twin[h]));
    EXPECT_EQ(end_of(s.triangles, h), start_of(s.triangles, twin[h]));
    EXPECT_EQ(next_in_triangle(previous_in_triangle(h)), h);
  }
}

TEST(IsClosedManifold, AcceptsCleanSurfaces) {
  for (const SurfaceMesh& s : {testing::cube(3), testing::unit_tetrahedron(), testing::icosphere(1),
                               testing::torus(6, 5), testing::hollow_sphere(1), SurfaceMesh{}})
    EXPECT_TRUE(closed_manifold(s));
}

TEST(IsClosedManifold, RefusesHolesTurnedAndDoubledTriangles) {
  const SurfaceMesh good = testing::icosphere(1);
  SurfaceMesh open = good, turned = good, doubled = good, repeated = good;
  open.triangles.pop_back();
  std::swap(turned.triangles[5][0], turned.triangles[5][1]);
  doubled.triangles.push_back(doubled.triangles[0]);
  repeated.triangles.push_back({3, 3, 4});
  for (const SurfaceMesh& s : {open, turned, doubled, repeated}) EXPECT_FALSE(closed_manifold(s));
}

TEST(IsClosedManifold, RefusesTwoFansAtAVertex) {
  SurfaceMesh s = testing::joined(testing::unit_tetrahedron(), testing::unit_tetrahedron());
  EXPECT_TRUE(closed_manifold(s));
  for (Triangle& t : s.triangles)
    for (VertexIndex& v : t)
      if (v == 4) v = 0;
  EXPECT_FALSE(closed_manifold(s));
  const auto twin = half_edge_twins(s.triangles, s.points.size());
  EXPECT_EQ(pinched_vertices(s.triangles, twin, s.points.size()), std::vector<VertexIndex>{0});
  // Both shells count the common vertex.
  const Shells shells = shells_of(s);
  ASSERT_EQ(shells.shells.size(), 2u);
  for (const auto& shell : shells.shells) EXPECT_EQ(shell.genus(), 0);
}

TEST(FindShells, CountsHandlesAndComponents) {
  EXPECT_EQ(shells_of(testing::cube(4)).shells.at(0).genus(), 0);
  EXPECT_EQ(shells_of(testing::torus(8, 6)).shells.at(0).genus(), 1);
  const SurfaceMesh both = testing::joined(testing::torus(8, 6), testing::icosphere(1));
  const Shells shells = shells_of(both);
  ASSERT_EQ(shells.shells.size(), 2u);
  EXPECT_EQ(shells.shells[0], (Shells::Shell{48, 144, 96}));
  EXPECT_EQ(shells.shells[1], (Shells::Shell{42, 120, 80}));
  EXPECT_EQ(shells.of_triangle.front(), 0u);
  EXPECT_EQ(shells.of_triangle.back(), 1u);
  EXPECT_EQ(edges_of(both.triangles).size(), 264u);
}

}  // namespace
}  // namespace octafront
