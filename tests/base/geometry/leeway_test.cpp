// How far a surface may move where its body is thin.

#include "base/geometry/leeway.h"

#include "support/named_surfaces.h"

#include <gtest/gtest.h>

namespace octafront {
namespace {

constexpr double kThick = 0.01, kAllowed = 0.1;

class LeewayOfAPlate : public ::testing::Test {
 protected:
  SurfaceMesh plate_ = testing::box(1, 1, kThick);
  TriangleTree tree_{plate_};
  Leeway leeway_{plate_, tree_};
};

TEST_F(LeewayOfAPlate, IsAPartOfTheThickness) {
  EXPECT_DOUBLE_EQ(leeway_.at({0.3, 0.4, kThick}, kAllowed), Leeway::kPart * kThick);
  EXPECT_DOUBLE_EQ(leeway_.at({0.3, 0.4, 1.2 * kThick}, kAllowed), Leeway::kPart * kThick);
}

TEST_F(LeewayOfAPlate, CountsTheShortestWayAtRimsAndCorners) {
  for (const Vec3 p : {Vec3{0.5, 0, 0}, Vec3{0.5, 1, kThick}, Vec3{1, 1, kThick}, Vec3{0, 0, 0}})
    EXPECT_NEAR(leeway_.at(p, kAllowed), Leeway::kPart * kThick, 1e-12);
}

TEST_F(LeewayOfAPlate, IsWhatIsAllowedWhereTheBodyIsThickEnough) {
  EXPECT_DOUBLE_EQ(leeway_.at({0.5, 0, kThick / 2}, kAllowed), kAllowed);  // on the narrow side: a way of 1 inward
  EXPECT_DOUBLE_EQ(leeway_.at({0.3, 0.4, 0}, 0.1 * kThick), 0.1 * kThick);
}

TEST(Leeway, OfAGapIsNotNarrowed) {
  const SurfaceMesh two = testing::joined(testing::cube(2), testing::transformed(testing::cube(2), 1, {1.001, 0, 0}));
  const TriangleTree tree(two);
  EXPECT_DOUBLE_EQ(Leeway(two, tree).at({1, 0.4, 0.3}, 0.1), 0.1);
}

TEST(Leeway, OfAComplexIsWhatIsAllowed) {
  SurfaceMesh plate = testing::box(1, 1, kThick);
  plate.sides.assign(plate.triangles.size(), {kNone, 0});
  const TriangleTree tree(plate);
  EXPECT_DOUBLE_EQ(Leeway(plate, tree).at({0.3, 0.4, 0}, kAllowed), kAllowed);
}

}  // namespace
}  // namespace octafront
