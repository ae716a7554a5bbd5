#include "mesh/surface_topology.h"

#include "support/named_surfaces.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace octafront {
namespace {

bool closed_manifold(const SurfaceMesh& s) {
  return is_closed_manifold(s.triangles, s.points.size());
}

TEST(EdgeTable, HoldsEachEdgeOnceWithItsHalfEdges) {
  const SurfaceMesh both = testing::joined(testing::torus(8, 6), testing::icosphere(1));
  const EdgeTable table = make_edge_table(both.points.size(), both.triangles);
  ASSERT_EQ(table.size(), 144u + 120u);
  EXPECT_TRUE(std::is_sorted(table.edges.begin(), table.edges.end()));
  std::size_t half_edges = 0;
  for (std::size_t e = 0; e < table.size(); ++e) {
    half_edges += table.uses(e).size();
    for (const HalfEdge h : table.uses(e)) {
      const auto [a, b] = std::minmax({start_of(both.triangles, h), end_of(both.triangles, h)});
      EXPECT_EQ(table.edges[e], (Edge{a, b}));
    }
  }
  EXPECT_EQ(half_edges, 3 * both.triangles.size());
}

TEST(HalfEdgeTwins, RunTheOtherWay) {
  const SurfaceMesh s = testing::torus(7, 5);
  const auto twin = half_edge_twins(s.triangles, s.points.size());
  for (HalfEdge h = 0; h < twin.size(); ++h) {
    ASSERT_NE(twin[h], kNone);
    EXPECT_EQ(twin[twin[h]], h);
    EXPECT_EQ(start_of(s.triangles, h), end_of(s.triangles, twin[h]));
    EXPECT_EQ(end_of(s.triangles, h), start_of(s.triangles, twin[h]));
    EXPECT_EQ(next_of(previous_of(h)), h);
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
}

}  // namespace
}  // namespace octafront
