#include "fill/front/backtrack.h"

#include <octafront/validity.h>

#include "fill/front/fill.h"
#include "fill/front/recover_cavity.h"
#include "support/named_surfaces.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace octafront {
namespace {

/// A filled sphere with a hole punched into it: the tetrahedra around one inner vertex are gone.
struct Punctured {
  SurfaceMesh surface = testing::icosphere(2);
  SizeField sizes = SizeField::uniform(0.3);
  VolumeOptions options;
  RunContext context;
  StageReport report;
  Stage stage{context, report};
  FrontTask task{sizes, options, stage};
  TetMesh mesh;
  std::vector<Wall> walls;

  Punctured() {
    options.core = VolumeOptions::Core::kOff;
    mesh = fill_volume(surface, sizes, options, stage);
    const auto center = static_cast<VertexIndex>(surface.points.size());
    std::vector<Tet> kept;
    for (const Tet& t : mesh.tets) {
      const auto it = std::find(t.begin(), t.end(), center);
      if (it == t.end()) {
        kept.push_back(t);
        continue;
      }
      // The face opposite the vertex, seen from it.
      const auto& f = kTetFaces[static_cast<std::size_t>(it - t.begin())];
      walls.push_back({t[f[0]], t[f[2]], t[f[1]]});
    }
    mesh.tets = kept;
  }

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
