#include "fill/front/backtrack.h"

#include <octafront/validity.h>

#include "fill/front/filled_sphere.h"
#include "fill/front/recover_cavity.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace octafront {
namespace {

/// A filled sphere with a hole punched into it: the tetrahedra around one inner vertex are gone.
struct Punctured : testing::FilledSphere {
  Punctured() : FilledSphere(2, 0.3) { punch(static_cast<VertexIndex>(surface.points.size())); }

  void expect_whole(WorkMesh& work) {
    TetMesh result = mesh;
    result.points = work.take_points();
    result.tets = work.take_tets();
    // The vertex that was taken out is no longer used: give it to nobody.
    std::vector<VertexIndex> number(result.points.size(), kNone);
    for (const Tet& t : result.tets)
      for (const VertexIndex v : t) number[v] = 0;
    std::vector<Vec3> points;
    for (VertexIndex v = 0; v < number.size(); ++v)
      if (number[v] == 0) {
        number[v] = static_cast<VertexIndex>(points.size());
        points.push_back(result.points[v]);
      }
    for (Tet& t : result.tets)
      for (VertexIndex& v : t) v = number[v];
    result.points = points;
    EXPECT_EQ(first_defect(result, surface), std::nullopt);
  }
};

TEST(Backtracking, FillsAHoleWithRingsAroundIt) {
  for (int rings = 0; rings < 3; ++rings) {
    SCOPED_TRACE(rings);
    Punctured p;
    WorkMesh work(p.mesh.points, p.mesh.tets);
    Cavities cavities(p.walls);
    std::uint64_t face_tests = 1'000'000;
    ASSERT_TRUE(
        close_by_front({work, cavities, 0}, {rings, 1.0, VolumeOptions::Ranking::kQuality}, p.task, face_tests));
    EXPECT_LT(face_tests, 1'000'000u);
    p.expect_whole(work);
  }
}

TEST(Backtracking, PutsEverythingBackWithoutSuccess) {
  Punctured p;
  WorkMesh work(p.mesh.points, p.mesh.tets);
  Cavities cavities(p.walls);
  std::uint64_t nothing = 0;
  EXPECT_FALSE(close_by_front({work, cavities, 0}, {}, p.task, nothing));
  EXPECT_EQ(cavities.walls(0), p.walls);
  EXPECT_EQ(work.take_tets(), p.mesh.tets);
}

TEST(Recovery, FillsAHoleWithRingsAroundIt) {
  for (int rings = 0; rings < 2; ++rings) {
    SCOPED_TRACE(rings);
    Punctured p;
    WorkMesh work(p.mesh.points, p.mesh.tets);
    Cavities cavities(p.walls);
    ASSERT_TRUE(close_by_recovery({work, cavities, 0}, rings, RunContext{}));
    p.expect_whole(work);
  }
}

}  // namespace
}  // namespace octafront
