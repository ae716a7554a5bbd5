#include "geometry/predicates.h"

#include "support/named_surfaces.h"

#include <gtest/gtest.h>

namespace octafront {
namespace {

TEST(Orient3d, UnitTetrahedronIsPositive) {
  EXPECT_EQ(orient3d({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}), 1);
  EXPECT_EQ(orient3d({0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}), -1);
}

TEST(NamedSurfaces, FaceOutward) {
  for (const SurfaceMesh& s : {testing::cube(3), testing::unit_tetrahedron(), testing::icosphere(2),
                               testing::torus(12, 8), testing::hollow_sphere(1)})
    EXPECT_GT(enclosed_volume(s), 0);
}

}  // namespace
}  // namespace octafront
