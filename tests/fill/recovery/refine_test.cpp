#include "fill/recovery/refine.h"

#include <octafront/error.h>
#include <octafront/size_field.h>
#include <octafront/validity.h>

#include "fill/recovery/recover.h"
#include "support/named_surfaces.h"
#include "support/nasty_surfaces.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <utility>

#include <gtest/gtest.h>

namespace octafront {
namespace {

TetMesh to_refine(const SurfaceMesh& surface) {
  StageReport report;
  return recover_volume(surface, {{}, report});
}

TetMesh refined(TetMesh mesh, const SizeField& sizes) {
  StageReport report;
  refine_interior(mesh, sizes, {{}, report});
  return mesh;
}

// Of the points from `first` on, to any other: the least distance over the size wanted there.
double least_spacing(const TetMesh& mesh, std::size_t first, const SizeField& sizes) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t v = first; v < mesh.points.size(); ++v) {
    for (std::size_t u = 0; u < v; ++u) {
      least = std::min(least, distance(mesh.points[u], mesh.points[v]) / sizes.at(mesh.points[v]));
    }
  }
  return least;
}

TEST(RefineInterior, MakesElementsOfTheSize) {
  const SurfaceMesh surface = testing::cube(8);
  const TetMesh coarse = to_refine(surface);
  const SizeField sizes = SizeField::uniform(1.0 / 8);
  const TetMesh mesh = refined(coarse, sizes);
  const auto defect = first_defect(mesh, surface);
  ASSERT_FALSE(defect) << *defect;
  EXPECT_EQ(mesh.boundary, surface.triangles);
  // A regular tetrahedron of edge h has h^3 / 8.5: the cube has room for 4,352 of them.
  EXPECT_GT(mesh.tets.size(), 3000u);
  EXPECT_LT(mesh.tets.size(), 6000u);
  EXPECT_GT(least_spacing(mesh, coarse.points.size(), sizes), 0.5);
}

TEST(RefineInterior, FollowsSizesThatVary) {
  const SurfaceMesh surface = testing::cube(4);
  const SizeField sizes = SizeField::from_function([](Vec3 p) { return 0.05 + 0.2 * p.x; }, 0.05, 0.25);
  const TetMesh coarse = to_refine(surface), mesh = refined(coarse, sizes);
  const auto defect = first_defect(mesh, surface);
  ASSERT_FALSE(defect) << *defect;
  const auto left = std::ranges::count_if(mesh.points, [](Vec3 p) { return p.x < 0.5; });
  EXPECT_GT(left, 3 * (static_cast<std::ptrdiff_t>(mesh.points.size()) - left));
  EXPECT_GT(least_spacing(mesh, coarse.points.size(), sizes), 0.5);
}

TEST(RefineInterior, LeavesAMeshOfTheRightSizeAlone) {
  const TetMesh coarse = to_refine(testing::icosphere(1));
  EXPECT_EQ(refined(coarse, SizeField::uniform(10)).tets, coarse.tets);
}

TEST(RefineInterior, KeepsNastySurfaces) {
  for (std::uint64_t seed = 0; seed < 26; ++seed) {
    const testing::NastySurface nasty = testing::nasty_surface(seed);
    SCOPED_TRACE(nasty.name);
    const double diagonal = bounding_box(nasty.surface.points).diagonal();
    const TetMesh mesh = refined(to_refine(nasty.surface), SizeField::uniform(0.05 * diagonal));
    const auto defect = first_defect(mesh, nasty.surface);
    EXPECT_FALSE(defect) << *defect;
  }
}

TEST(RefineInterior, EndsWhenCancelled) {
  TetMesh mesh = to_refine(testing::cube(4));
  const std::atomic<bool> cancel = true;
  RunContext context;
  context.cancel = &cancel;
  StageReport report;
  EXPECT_THROW(refine_interior(mesh, SizeField::uniform(0.01), {context, report}), Cancelled);
}

}  // namespace
}  // namespace octafront
