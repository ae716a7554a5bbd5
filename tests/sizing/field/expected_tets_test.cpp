#include "sizing/field/expected_tets.h"

#include "sizing/field/affordable.h"
#include "sizing/size_cases.h"
#include "support/named_surfaces.h"

#include <cmath>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using testing::box;
using testing::cube;
using testing::each;
using testing::sizes_of;

TEST(ExpectedTets, OfACube) {
  SizeOptions o;
  o.size = 0.05;
  const double n = expected_tets(sizes_of(cube(4), o), cube(4));
  EXPECT_NEAR(n, kTetsPerCube * 8000, 1);
  o.callback = each([](Vec3) { return 0.05; });
  EXPECT_NEAR(expected_tets(sizes_of(cube(4), o), cube(4)), n, 0.01 * n);
}

/// One layer of prisms, three elements for the two triangles of each, however thin.
TEST(ExpectedTets, OfAPlateThinnerThanItsElements) {
  SizeOptions o;
  o.size = 0.02;
  const double one_layer = 1.5 * 2 * 4 / std::sqrt(3) / (0.02 * 0.02);
  for (const double thickness : {1e-2, 1e-3, 1e-5, 1e-9}) {
    const SurfaceMesh plate = box(1, 1, thickness, 1);
    EXPECT_NEAR(expected_tets(sizes_of(plate, o), plate), one_layer, 0.05 * one_layer) << thickness;
  }
}

}  // namespace
}  // namespace octafront
