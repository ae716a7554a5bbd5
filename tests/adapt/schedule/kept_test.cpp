#include <octafront/adapt.h>
#include <octafront/error.h>
#include <octafront/validity.h>

#include "improve/start_meshes.h"

#include <algorithm>
#include <array>
#include <set>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using ::octafront::testing::kuhn_cube;
using ::octafront::testing::volume;

using Places = std::array<std::array<double, 3>, 3>;

/// The triangles, or those of a patch, by the places of their corners, to be told apart in any order.
std::multiset<Places> triangles_of(const TetMesh& mesh, std::uint32_t patch = kNone) {
  std::multiset<Places> all;
  for (std::size_t f = 0; f < mesh.boundary.size(); ++f) {
    if (patch != kNone && mesh.patch[f] != patch) continue;
    Places places;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 p = mesh.points[mesh.boundary[f][i]];
      places[i] = {p.x, p.y, p.z};
    }
    std::sort(places.begin(), places.end());
    all.insert(places);
  }
  return all;
}

TetMesh named_cube(int n) {
  TetMesh mesh = kuhn_cube(n);
  mesh.patch_names = {"a", "b", "c", "d", "e", "f"};
  return mesh;
}

AdaptedMesh keeping(const TetMesh& mesh, double size, const std::string& keep, bool boundary = false, int threads = 0) {
  Options options;
  options.size.size = size;
  options.adapt.keep = keep;
  options.improve.move_boundary = !boundary;
  RunContext context;
  context.threads = threads;
  return adapt_existing(mesh, options, context);
}

TEST(AdaptKept, BoundaryStaysFinerAndCoarser) {
  const TetMesh start = named_cube(5);
  for (const double size : {0.09, 0.5}) {
    const AdaptedMesh made = keeping(start, size, "", true);
    EXPECT_EQ(first_defect(made.mesh), std::nullopt);
    EXPECT_EQ(triangles_of(made.mesh), triangles_of(start));
    EXPECT_NE(made.mesh.tets.size(), start.tets.size());
    EXPECT_TRUE(made.mesh.sets.empty());
    EXPECT_GT(made.after.quality_min, 0.3);
  }
}

/// Edges inside whose ends are both on the boundary stay in nobody's way.
TEST(AdaptKept, BodyWithoutAVertexInsideGetsSome) {
  const TetMesh start = named_cube(1);
  const AdaptedMesh made = keeping(start, 0.2, "", true);
  EXPECT_EQ(triangles_of(made.mesh), triangles_of(start));
  EXPECT_GT(made.mesh.points.size(), start.points.size());
}

TEST(AdaptKept, PatchByNameOrNumberStaysAndOthersChange) {
  const TetMesh start = named_cube(4);
  const AdaptedMesh named = keeping(start, 0.14, "b"), numbered = keeping(start, 0.14, "2");
  EXPECT_EQ(named.mesh, numbered.mesh);
  EXPECT_EQ(triangles_of(named.mesh, 1), triangles_of(start, 1));
  for (const std::uint32_t other : {0u, 2u, 3u, 4u, 5u})
    EXPECT_GT(triangles_of(named.mesh, other).size(), 2 * triangles_of(start, other).size()) << other;
  EXPECT_NEAR(volume(named.mesh), 1, 1e-12);
  const AdaptedMesh two = keeping(start, 0.14, "b;e");
  EXPECT_EQ(triangles_of(two.mesh, 1), triangles_of(start, 1));
  EXPECT_EQ(triangles_of(two.mesh, 4), triangles_of(start, 4));
}

TEST(AdaptKept, RequiredItemsOfMeditStayUnasked) {
  TetMesh start = named_cube(4);
  VertexIndex inner = 0, side = 0;
  for (VertexIndex v = 0; v < start.points.size(); ++v) {
    if (start.points[v] == Vec3{0.5, 0.5, 0.5}) inner = v;
    if (start.points[v] == Vec3{0.5, 0.5, 1}) side = v;
  }
  const Edge edge{start.boundary[7][0], start.boundary[7][1]};
  start.curve_edges = {edge}, start.curve = {0};
  start.sets = {{"RequiredVertices", NamedSet::Kind::kNodes, {inner, side}},
                {"RequiredEdges", NamedSet::Kind::kEdges, {0}},
                {"RequiredTriangles", NamedSet::Kind::kFaces, {0, 20}}};
  std::sort(start.sets[0].members.begin(), start.sets[0].members.end());
  for (const double size : {0.14, 0.7}) {
    const AdaptedMesh made = keeping(start, size, "");
    const TetMesh& mesh = made.mesh;
    ASSERT_EQ(mesh.sets.size(), 3u);
    ASSERT_EQ(mesh.sets[0].members.size(), 2u);
    const std::set<double> xs{mesh.points[mesh.sets[0].members[0]].z, mesh.points[mesh.sets[0].members[1]].z};
    EXPECT_EQ(xs, (std::set<double>{0.5, 1}));
    ASSERT_EQ(mesh.curve_edges.size(), 1u);
    const std::set<VertexIndex> had{edge[0], edge[1]},
        has{made.old_of_new[mesh.curve_edges[0][0]], made.old_of_new[mesh.curve_edges[0][1]]};
    EXPECT_EQ(had, has);
    ASSERT_EQ(mesh.sets[2].members.size(), 2u);
    const std::multiset<Places> all = triangles_of(start);
    TetMesh two = mesh;
    two.boundary = {mesh.boundary[mesh.sets[2].members[0]], mesh.boundary[mesh.sets[2].members[1]]};
    for (const Places& p : triangles_of(two)) EXPECT_TRUE(all.contains(p));
    EXPECT_EQ(first_defect(mesh), std::nullopt);
  }
}

TEST(AdaptKept, SameBitsForAnyNumberOfThreads) {
  const TetMesh start = named_cube(6);
  EXPECT_EQ(keeping(start, 0.1, "c", false, 1).mesh, keeping(start, 0.1, "c", false, 2).mesh);
}

TEST(AdaptKept, UnknownNamesAreRefusedWithThoseThatThereAre) {
  for (const char* wrong : {"nobody", "7", "0"}) try {
      keeping(named_cube(2), 0.3, wrong);
      FAIL() << wrong;
    } catch (const OptionError& error) {
      EXPECT_NE(std::string(error.what()).find("patches \"a\", \"b\", \"c\", \"d\", \"e\", \"f\""), std::string::npos)
          << error.what();
    }
}

}  // namespace
}  // namespace octafront
