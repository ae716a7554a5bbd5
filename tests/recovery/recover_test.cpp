#include "recovery/recover.h"

#include <octafront/error.h>
#include <octafront/validity.h>

#include "support/named_surfaces.h"

#include <gtest/gtest.h>

namespace octafront {
namespace {

TetMesh recovered(const SurfaceMesh& surface) {
  StageReport report;
  return recover_volume(surface, {}, report);
}

void expect_kept(const SurfaceMesh& surface) {
  const TetMesh mesh = recovered(surface);
  const auto defect = first_defect(mesh, surface);
  EXPECT_FALSE(defect) << *defect;
  EXPECT_EQ(mesh.boundary, surface.triangles);
}

TEST(RecoverVolume, KeepsNamedSurfaces) {
  expect_kept(testing::unit_tetrahedron());
  expect_kept(testing::cube());
  expect_kept(testing::icosphere(2));
  expect_kept(testing::torus(24, 10));
  expect_kept(testing::hollow_sphere(2));
}

TEST(RecoverVolume, KeepsThousandsOfCoplanarPoints) { expect_kept(testing::cube(16)); }

TEST(RecoverVolume, KeepsSeveralBodies) {
  expect_kept(testing::joined(testing::cube(2), testing::transformed(testing::icosphere(1), 0.5, {3, 0, 0})));
}

TEST(RecoverVolume, RefusesAnOpenSurface) {
  SurfaceMesh open = testing::cube();
  open.triangles.pop_back();
  EXPECT_THROW(recovered(open), MeshingError);
}

TEST(RecoverVolume, RefusesAnInsideOutSurface) { EXPECT_THROW(recovered(testing::reversed(testing::cube())), MeshingError); }

}  // namespace
}  // namespace octafront
