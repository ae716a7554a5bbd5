#include "fill/front/excavation.h"

#include <octafront/error.h>

#include "fill/front/open_edge.h"
#include "support/named_surfaces.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

namespace octafront {
namespace {

/// Six tetrahedra around the long diagonal of the unit cube.
struct SixInACube {
  std::vector<Vec3> points;
  std::vector<Tet> tets;
  SixInACube() {
    for (int i = 0; i < 8; ++i) points.push_back({double(i & 1), double(i >> 1 & 1), double(i >> 2 & 1)});
    constexpr int kAround[6] = {1, 3, 2, 6, 4, 5};
    for (int i = 0; i < 6; ++i)
      tets.push_back({0, static_cast<VertexIndex>(kAround[i]), static_cast<VertexIndex>(kAround[(i + 1) % 6]), 7});
  }
};

std::vector<Wall> walls_around(const Tet& t) {
  std::vector<Wall> walls;
  for (const auto& f : kTetFaces) walls.push_back({t[f[0]], t[f[2]], t[f[1]]});
  return walls;
}

TEST(Excavation, RollsBackWithoutCommit) {
  SixInACube c;
  const Tet missing = c.tets.back();
  c.tets.pop_back();
  WorkMesh mesh(c.points, c.tets);
  Cavities cavities(walls_around(missing));
  {
    Excavation e({mesh, cavities, 0});
    EXPECT_TRUE(e.grow_ring());
    EXPECT_EQ(e.size(), 12u);  // the whole cube is open: its surface is what remains
    EXPECT_FALSE(e.grow_ring());
  }
  EXPECT_EQ(cavities.walls(0).size(), 4u);
  EXPECT_EQ(mesh.take_tets(), c.tets);
}

TEST(Excavation, DoesNotGrowThroughATriangleWithSomethingOnBothSides) {
  SixInACube c;
  const Tet missing = c.tets.back();
  c.tets.pop_back();
  // One of the two walls inside the cube is a triangle between regions.
  const Triangle between{missing[0], missing[1], missing[3]};
  WorkMesh mesh(c.points, c.tets, {}, {between});
  Cavities cavities(walls_around(missing));
  {
    Excavation e({mesh, cavities, 0});
    int grown = 0;
    for (const Wall& w : e.walls()) grown += e.grow_through(w);
    EXPECT_EQ(grown, 1);
  }
  // What lies on both sides may still go with a ring: then the triangle is a wall twice.
  Excavation e({mesh, cavities, 0});
  EXPECT_TRUE(e.grow_ring());
  EXPECT_EQ(e.size(), 14u);
  const std::vector<Wall> walls = e.walls();
  EXPECT_EQ(std::count_if(walls.begin(), walls.end(), [&](const Wall& w) { return face_key(w) == face_key(between); }),
            2);
}

TEST(Excavation, StopsAtTheSurface) {
  SixInACube c;
  const Tet missing = c.tets.back();
  c.tets.pop_back();
  WorkMesh mesh(c.points, c.tets);
  Cavities cavities(walls_around(missing));
  Excavation e({mesh, cavities, 0});
  int grown = 0;
  for (const Wall& w : e.walls()) grown += e.grow_through(w);
  EXPECT_EQ(grown, 2);  // of four walls two belong to the cube's surface
  EXPECT_EQ(e.size(), 8u);
}

TEST(Excavation, RunsIntoOtherCavitiesAndTakesThemAlong) {
  SixInACube c;
  const Tet first = c.tets[0], second = c.tets[3];
  c.tets.erase(c.tets.begin() + 3);
  c.tets.erase(c.tets.begin());
  WorkMesh mesh(c.points, c.tets);
  std::vector<Wall> walls = walls_around(first);
  for (const Wall& w : walls_around(second)) walls.push_back(w);
  Cavities cavities(walls);
  // They share the long diagonal, so they are one pinched cavity from the start.
  ASSERT_EQ(cavities.size(), 1u);
  Excavation e({mesh, cavities, 0});
  EXPECT_TRUE(e.grow_ring());
  EXPECT_EQ(e.size(), 12u);
  e.commit();
  EXPECT_TRUE(cavities.walls(0).empty());
  EXPECT_TRUE(mesh.take_tets().empty());
}

TEST(Excavation, SaysWhereTetrahedraOverlap) {
  SixInACube c;
  const Tet missing = c.tets.back();
  c.tets.back() = c.tets[2];  // twice the same space, as fronts fill a surface that crosses itself
  WorkMesh mesh(c.points, c.tets);
  Cavities cavities(walls_around(missing));
  EXPECT_THROW(Excavation({mesh, cavities, 0}).grow_ring(), MeshingError);
  EXPECT_EQ(mesh.take_tets(), c.tets);
}

TEST(WorkMesh, FindsTheTetrahedronBehindAFace) {
  SixInACube c;
  WorkMesh mesh(c.points, c.tets);
  for (TetIndex t = 0; t < c.tets.size(); ++t)
    for (const auto& f : kTetFaces) {
      const Triangle outward{c.tets[t][f[0]], c.tets[t][f[1]], c.tets[t][f[2]]};
      EXPECT_EQ(mesh.tet_behind(outward), t);
      EXPECT_EQ(mesh.tet_behind({outward[1], outward[2], outward[0]}), t);
    }
  mesh.remove(2);
  EXPECT_EQ(mesh.tet_behind({c.tets[2][1], c.tets[2][2], c.tets[2][3]}), kNone);
}

TEST(WorkMesh, FocusChangesNoAnswer) {
  SixInACube c;
  const WorkMesh all(c.points, c.tets), some(c.points, c.tets, {{{-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}}});
  for (VertexIndex v = 0; v < c.points.size(); ++v) EXPECT_EQ(some.around(v), all.around(v)) << v;
}

/// What a working structure complains of, said or thrown (where structures check themselves).
template <class Break>
std::string complaint(const Break& broken) {
  try {
    return broken().value_or("");
  } catch (const std::logic_error& error) {
    return error.what();
  }
}

TEST(WorkMesh, FindsWhatIsWrongWithIt) {
  const SixInACube c;
  EXPECT_EQ(WorkMesh(c.points, c.tets).first_inconsistency(), std::nullopt);
  const auto with = [&](const Tet& tet) {
    return complaint([&] {
      WorkMesh mesh(c.points, c.tets);
      return mesh.first_inconsistency(mesh.add(tet));
    });
  };
  EXPECT_EQ(with({0, 1, 3, 3}), "tetrahedron 6 is not positive");
  EXPECT_EQ(with({1, 0, 3, 7}), "tetrahedron 6 is not positive");
  EXPECT_EQ(with(c.tets[2]), "tetrahedron 6 shares a side of a face with another");
}

TEST(Cavities, FindWhatIsWrongWithThem) {
  const SixInACube c;
  std::vector<Wall> walls = walls_around(c.tets[0]);
  EXPECT_EQ(Cavities(walls).first_inconsistency(), std::nullopt);
  walls.pop_back();
  EXPECT_NE(complaint([&] { return Cavities(walls).first_inconsistency(); }).find("open at the edge"),
            std::string::npos);
}

TEST(OpenEdge, IsFoundWhereFacesEndOrTurn) {
  std::vector<Triangle> faces = testing::icosphere(1).triangles;
  EXPECT_EQ(first_open_edge(faces), std::nullopt);
  std::swap(faces[7][0], faces[7][1]);
  EXPECT_NE(first_open_edge(faces), std::nullopt);
  faces.erase(faces.begin() + 7);
  EXPECT_NE(first_open_edge(faces), std::nullopt);
}

}  // namespace
}  // namespace octafront
