#include "base/mesh/surface_topology.h"

#include "base/mesh/half_edge_mesh.h"
#include "support/named_surfaces.h"

#include <algorithm>
#include <functional>
#include <string>

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

TEST(EdgeTable, FindsWhatIsBroken) {
  const SurfaceMesh s = testing::torus(8, 6);
  const auto complaint = [&](const std::function<void(EdgeTable&)>& breaks) {
    EdgeTable table = make_edge_table(s.points.size(), s.triangles);
    breaks(table);
    return table.first_inconsistency(s.triangles).value_or("");
  };
  EXPECT_EQ(complaint([](EdgeTable&) {}), "");
  EXPECT_EQ(complaint([](EdgeTable& t) { t.first.pop_back(); }),
            "the edges of the table do not share out its half-edges");
  EXPECT_EQ(complaint([](EdgeTable& t) { t.first[6] = t.first[5]; }), "edge 5 of the table has no half-edge");
  EXPECT_EQ(complaint([](EdgeTable& t) { std::swap(t.edges[3][0], t.edges[3][1]); }),
            "edge 3 of the table has its larger vertex first");
  EXPECT_EQ(complaint([](EdgeTable& t) { t.edges[8] = t.edges[7]; }),
            "edge 8 of the table is not behind the one before it");
  EXPECT_EQ(complaint([](EdgeTable& t) { std::swap(t.half_edges[4], t.half_edges[5]); }),
            "edge 2 of the table has half-edges that do not ascend");
  EXPECT_EQ(complaint([](EdgeTable& t) { std::swap(t.half_edges[4], t.half_edges[6]); }),
            "edge 2 of the table has a half-edge that runs along another one");
  EdgeTable shorter = make_edge_table(s.points.size(), s.triangles);
  EXPECT_NE(shorter.first_inconsistency(std::span(s.triangles).first(90)), std::nullopt);
}

TEST(HalfEdgeMesh, FindsWhatIsBroken) {
  const HalfEdgeMesh good = make_half_edge_mesh(testing::torus(8, 6));
  const HalfEdge h = 10, g = good.twin[h];
  const VertexIndex v = good.start[h];
  const auto complaint = [&](const std::function<void(HalfEdgeMesh&)>& breaks) {
    HalfEdgeMesh mesh = good;
    breaks(mesh);
    return mesh.first_inconsistency().value_or("");
  };
  const auto expect_found = [&](const std::function<void(HalfEdgeMesh&)>& breaks, const std::string& fragment) {
    const std::string wrong = complaint(breaks);
    EXPECT_NE(wrong.find(fragment), std::string::npos) << wrong;
  };
  EXPECT_EQ(complaint([](HalfEdgeMesh&) {}), "");
  expect_found([&](HalfEdgeMesh& m) { m.twin[h] = kNone; }, "twin");
  expect_found([&](HalfEdgeMesh& m) { m.twin[h] = m.twin[next_of(h)]; }, "does not know its twin");
  expect_found([&](HalfEdgeMesh& m) { m.is_feature[g] = 1; }, "not both features");
  expect_found([&](HalfEdgeMesh& m) { m.outgoing[v] = next_of(h); }, "leaving vertex " + std::to_string(v));
  expect_found([&](HalfEdgeMesh& m) { m.outgoing[v] = kNone; }, "the star of vertex " + std::to_string(v));
  expect_found([&](HalfEdgeMesh& m) { m.points.push_back({}); }, "differ in length");
  // Both of two edges, each tied to the other's other side.
  expect_found(
      [&](HalfEdgeMesh& m) {
        const HalfEdge o = next_of(h), p = m.twin[o];
        m.twin[h] = p, m.twin[p] = h, m.twin[o] = g, m.twin[g] = o;
      },
      "do not run along one edge in opposite directions");
  EXPECT_NE(
      [&] {
        HalfEdgeMesh mesh = good;
        mesh.is_feature[g] = 1;
        return mesh.first_inconsistency(v);
      }(),
      std::nullopt);
  // Two fans at one vertex: each edge is in order, and half of the triangles are not reached.
  const SurfaceMesh two = testing::joined(testing::icosphere(0), testing::icosphere(0));
  HalfEdgeMesh pinched = make_half_edge_mesh(two);
  std::ranges::replace(pinched.start, 12u, 0u);
  pinched.outgoing[12] = kNone;
  EXPECT_EQ(pinched.first_inconsistency(), "the star of vertex 0 lacks triangles that have it");
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
