#include <octafront/error.h>
#include <octafront/repair.h>
#include <octafront/run_context.h>

#include "support/named_surfaces.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include <gtest/gtest.h>

namespace octafront {
namespace {

SurfaceDefects defects_of(const SurfaceMesh& surface) {
  return find_defects(repair_surface(surface));
}

TEST(Defects, NamedSurfacesAreClean) {
  for (const SurfaceMesh& s : {testing::cube(3), testing::unit_tetrahedron(), testing::icosphere(2),
                               testing::torus(12, 8), testing::hollow_sphere(1)}) {
    const SurfaceDefects defects = defects_of(s);
    EXPECT_TRUE(defects.clean()) << defects.describe();
    EXPECT_EQ(defects.describe(), "");
  }
}

TEST(Defects, TwoHolesAreCountedWithTheirEdges) {
  SurfaceMesh s = testing::icosphere(2);
  s.triangles.erase(s.triangles.begin() + 100);
  s.triangles.erase(s.triangles.begin() + 5);
  const SurfaceDefects defects = defects_of(s);
  EXPECT_EQ(defects.open_edges.count, 6u);
  EXPECT_EQ(defects.open_loops, 2u);
  ASSERT_EQ(defects.open_edges.first.size(), 6u);
  EXPECT_NE(defects.describe().find("2 holes (6 open edges)"), std::string::npos) << defects.describe();
}

TEST(Defects, HolesThatTouchInAVertexAreTwo) {
  SurfaceMesh s = testing::cube(4);
  s.patch.clear();
  // Two triangles that share a vertex but no edge.
  const Triangle first = s.triangles[9];
  for (std::size_t t = 10; t < s.triangles.size(); ++t) {
    int shared = 0;
    for (const VertexIndex v : s.triangles[t]) shared += std::count(first.begin(), first.end(), v);
    if (shared != 1) continue;
    s.triangles.erase(s.triangles.begin() + t);
    break;
  }
  s.triangles.erase(s.triangles.begin() + 9);
  const SurfaceDefects defects = defects_of(s);
  EXPECT_EQ(defects.open_edges.count, 6u);
  EXPECT_EQ(defects.open_loops, 2u);
  EXPECT_EQ(defects.non_manifold_vertices.count, 1u);
}

TEST(Defects, CubesThatShareAnEdge) {
  const SurfaceMesh s = testing::joined(testing::cube(), testing::transformed(testing::cube(), 1, {1, 1, 0}));
  const SurfaceDefects defects = defects_of(s);
  EXPECT_EQ(defects.non_manifold_edges.count, 1u);
  ASSERT_EQ(defects.non_manifold_edges.first.size(), 1u);
  EXPECT_EQ(defects.non_manifold_edges.first[0].at, (Vec3{1, 1, 0.5}));
  EXPECT_EQ(defects.non_manifold_edges.first[0].faces.size(), 4u);
  EXPECT_EQ(defects.non_manifold_vertices.count, 0u);
}

TEST(Defects, CubesThatShareAVertex) {
  const SurfaceMesh s = testing::joined(testing::cube(), testing::transformed(testing::cube(), 1, {1, 1, 1}));
  const SurfaceDefects defects = defects_of(s);
  EXPECT_EQ(defects.non_manifold_vertices.count, 1u);
  ASSERT_EQ(defects.non_manifold_vertices.first.size(), 1u);
  EXPECT_EQ(defects.non_manifold_vertices.first[0].at, (Vec3{1, 1, 1}));
  EXPECT_EQ(defects.non_manifold_vertices.first[0].faces.size(), 2u);
  EXPECT_EQ(defects.non_manifold_edges.count, 0u);
}

SurfaceMesh moebius_strip(int n) {
  SurfaceMesh s;
  for (int i = 0; i < n; ++i) {
    const double u = 6.283185307179586 * i / n;
    for (const double w : {-0.3, 0.3}) {
      const double r = 1 + w * std::cos(u / 2);
      s.points.push_back({r * std::cos(u), r * std::sin(u), w * std::sin(u / 2)});
    }
  }
  for (int i = 0; i < n; ++i) {
    const auto a = static_cast<VertexIndex>(2 * i), b = a + 1;
    VertexIndex c = (a + 2) % (2 * n), d = (b + 2) % (2 * n);
    if (i == n - 1) std::swap(c, d);
    s.triangles.push_back({a, c, b});
    s.triangles.push_back({b, c, d});
  }
  return s;
}

TEST(Defects, MoebiusStripCannotBeOriented) {
  const RepairedSurface repaired = repair_surface(moebius_strip(16));
  const SurfaceDefects defects = find_defects(repaired);
  EXPECT_GE(defects.misoriented_edges.count, 1u);
  EXPECT_EQ(defects.open_loops, 1u);
  ASSERT_FALSE(repaired.notes.empty());
  EXPECT_NE(repaired.notes.back().find("cannot be oriented"), std::string::npos);
}

TEST(Defects, PlacesNameInputFacesInOrder) {
  SurfaceMesh s = testing::cube(6);
  s.triangles.erase(s.triangles.begin() + 50, s.triangles.begin() + 90);
  for (std::uint32_t t = 0; t < s.triangles.size(); ++t) s.source.push_back(1000 + 7 * t);
  s.patch.clear();
  const SurfaceDefects defects = find_defects(repair_surface(s));
  ASSERT_EQ(defects.open_edges.first.size(), 10u);
  EXPECT_GT(defects.open_edges.count, 10u);
  for (std::size_t i = 0; i < 10; ++i) {
    const auto& faces = defects.open_edges.first[i].faces;
    ASSERT_EQ(faces.size(), 1u);
    EXPECT_EQ((faces[0] - 1000) % 7, 0u);
    EXPECT_TRUE(i == 0 || defects.open_edges.first[i - 1].faces[0] <= faces[0]);
  }
}

TEST(Defects, OrderOfTheInputChangesNoCount) {
  std::mt19937 random(1);
  for (int round = 0; round < 20; ++round) {
    SurfaceMesh s = testing::icosphere(3);
    for (Vec3& p : s.points) p = p * (1 + 1e-3 * (random() % 1000) / 1000);
    std::shuffle(s.triangles.begin(), s.triangles.end(), random);
    s.triangles.resize(s.triangles.size() / 20 * (2 + random() % 18));
    const SurfaceDefects before = defects_of(s);
    std::shuffle(s.triangles.begin(), s.triangles.end(), random);
    for (Triangle& t : s.triangles) std::rotate(t.begin(), t.begin() + random() % 3, t.end());
    const SurfaceDefects after = defects_of(s);
    EXPECT_EQ(after.open_edges.count, before.open_edges.count);
    EXPECT_EQ(after.open_loops, before.open_loops);
    EXPECT_EQ(after.non_manifold_vertices.count, before.non_manifold_vertices.count);
    EXPECT_EQ(after.self_intersections.count, before.self_intersections.count);
  }
}

TEST(Defects, ShellsThatCutEachOther) {
  const SurfaceMesh s =
      testing::joined(testing::icosphere(1), testing::transformed(testing::icosphere(1), 1, {0.7, 0.1, 0}));
  const SurfaceDefects defects = defects_of(s);
  EXPECT_GT(defects.self_intersections.count, 10u);
  ASSERT_EQ(defects.self_intersections.first.size(), 10u);
  for (const auto& place : defects.self_intersections.first) {
    ASSERT_EQ(place.faces.size(), 2u);
    EXPECT_LT(place.faces[0], 80u);
    EXPECT_GE(place.faces[1], 80u);
    EXPECT_NEAR(length(place.at), 1, 0.2);
  }
  EXPECT_FALSE(defects.clean());
}

TEST(Defects, ShellsThatTouchInAPointOfAFace) {
  // The tip of the second tetrahedron lies inside a face of the first.
  SurfaceMesh tip = testing::transformed(testing::unit_tetrahedron(), 1, {0.25, 0.25, -1});
  tip.points[3] = {0.25, 0.25, 0};
  const SurfaceDefects defects = defects_of(testing::joined(testing::unit_tetrahedron(), tip));
  EXPECT_EQ(defects.self_intersections.count, 3u);
  EXPECT_EQ(defects.self_intersections.first[0].at, (Vec3{0.25, 0.25, 0}));
  SurfaceMesh apart = tip;
  apart.points[3].z = -1e-40;
  EXPECT_TRUE(defects_of(testing::joined(testing::unit_tetrahedron(), apart)).clean());
}

TEST(Defects, RepairAndSearchStopWhenAsked) {
  const SurfaceMesh soup = testing::icosphere(3);
  const RepairedSurface repaired = repair_surface(soup);
  const std::atomic<bool> stop{true};
  RunContext context;
  context.cancel = &stop;
  EXPECT_THROW(repair_surface(soup, context), Cancelled);
  EXPECT_THROW(find_defects(repaired, context), Cancelled);
}

TEST(Defects, MessageSaysHowManyWhereAndWhatToDo) {
  SurfaceMesh s = testing::transformed(testing::cube(), 2, {0, 0, 0});
  s.triangles.pop_back();
  s.patch.clear();
  EXPECT_EQ(
      defects_of(s).describe(),
      "1 hole (3 open edges): edge at (0, 1, 2) (face 0); edge at (1, 2, 2) (face 6); edge at (1, 1, 2) (face 10). "
      "`octafront repair` closes holes, and joins edges that only fail to touch.");
}

TEST(Defects, TheErrorSaysThePlacesAndCarriesThem) {
  SurfaceMesh s = testing::icosphere(1);
  s.triangles.pop_back();
  const SurfaceDefects defects = defects_of(s);
  const DefectsError error(defects);
  EXPECT_EQ(error.what(), defects.describe());
  EXPECT_NE(defects.describe().find("edge at ("), std::string::npos);
  EXPECT_EQ(error.defects.open_edges.first.size(), 3u);
}

TEST(Defects, NoMessageSendsAnybodyToAnotherProgram) {
  SurfaceDefects d;
  for (SurfaceDefects::Kind* kind :
       {&d.open_edges, &d.non_manifold_edges, &d.misoriented_edges, &d.non_manifold_vertices, &d.self_intersections,
        &d.degenerate_faces, &d.region_conflicts, &d.misplaced_parts})
    kind->count = 1;
  const std::string text = d.describe();
  for (const char* other : {"MeshLab", "Blender", "e.g. "}) EXPECT_EQ(text.find(other), std::string::npos) << text;
  for (const char* ours : {"`octafront repair`", "`cells`", "`overlap`"})
    EXPECT_NE(text.find(ours), std::string::npos) << text;
}

TEST(Defects, MessageHasALineForEachKindAndNoneBehind) {
  SurfaceDefects defects;
  defects.open_edges.count = defects.degenerate_faces.count = 1;
  const std::string text = defects.describe();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
  EXPECT_NE(text.back(), '\n');
}

}  // namespace
}  // namespace octafront
