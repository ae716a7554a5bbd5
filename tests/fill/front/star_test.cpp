#include "fill/front/star.h"

#include <octafront/validity.h>

#include "base/mesh/face_table.h"
#include "support/named_surfaces.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace octafront {
namespace {

/// A surface as one big cavity with nothing around it.
std::vector<Wall> walls_of(const SurfaceMesh& s) {
  std::vector<Wall> walls;
  for (const auto& [a, b, c] : s.triangles) walls.push_back({a, c, b});
  return walls;
}

TEST(Star, ClosesStarShapedSurfaces) {
  for (const SurfaceMesh& s : {testing::unit_tetrahedron(), testing::cube(5), testing::icosphere(2)}) {
    WorkMesh mesh(s.points, {});
    Cavities cavities(walls_of(s));
    ASSERT_EQ(cavities.size(), 1u);
    const StarResult r = close_by_star({mesh, cavities, 0});
    EXPECT_TRUE(r.closed);
    EXPECT_EQ(r.growth_steps, 0);
    EXPECT_TRUE(cavities.walls(0).empty());
    TetMesh result;
    result.points = mesh.take_points();
    result.tets = mesh.take_tets();
    result.boundary = s.triangles;
    EXPECT_EQ(first_defect(result, s), std::nullopt);
  }
}

TEST(Star, LeavesWhatHasNoKernelAsItWas) {
  const SurfaceMesh s = testing::torus(12, 6);
  WorkMesh mesh(s.points, {});
  Cavities cavities(walls_of(s));
  EXPECT_FALSE(close_by_star({mesh, cavities, 0}).closed);
  EXPECT_EQ(cavities.walls(0).size(), s.triangles.size());
  EXPECT_TRUE(mesh.take_tets().empty());
}

TEST(Star, GrowsUntilThereIsAKernel) {
  // A sphere filled by a star; two cones on opposite sides are taken out: only their tips see both.
  const SurfaceMesh s = testing::icosphere(2);
  std::vector<Vec3> points = s.points;
  points.push_back({0.05, 0.03, 0.02});
  const auto center = static_cast<VertexIndex>(s.points.size());
  std::vector<Tet> tets;
  std::vector<Wall> walls;
  for (const auto& [a, b, c] : s.triangles) {
    const Vec3 m = (points[a] + points[b] + points[c]) / 3;
    if (std::abs(m.z) < 0.6) {
      tets.push_back({a, c, b, center});
      continue;
    }
    walls.push_back({a, c, b});
  }
  // The sides of the cones: faces of kept tetrahedra that have lost their neighbour.
  std::map<Triangle, std::pair<Wall, int>> sides;
  for (const Tet& t : tets)
    for (const auto& f : kTetFaces) {
      const Triangle outward{t[f[0]], t[f[1]], t[f[2]]};
      if (std::find(outward.begin(), outward.end(), center) == outward.end()) continue;
      auto& [wall, count] = sides[face_key(outward)];
      wall = outward;
      ++count;
    }
  for (const auto& [key, side] : sides)
    if (side.second == 1) walls.push_back(side.first);
  WorkMesh mesh(points, tets);
  Cavities cavities(walls);
  ASSERT_EQ(cavities.size(), 2u);
  for (std::uint32_t c = 0; c < 2; ++c) {
    if (cavities.walls(c).empty()) continue;
    EXPECT_TRUE(close_by_star({mesh, cavities, c}).closed);
  }
  TetMesh result;
  result.points = mesh.take_points();
  result.tets = mesh.take_tets();
  result.boundary = s.triangles;
  EXPECT_EQ(first_defect(result, s), std::nullopt);
}

}  // namespace
}  // namespace octafront
