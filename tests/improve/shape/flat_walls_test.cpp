// What counts as a wall that is meant to be flat.

#include "improve/shape/flat_walls.h"

#include "support/named_surfaces.h"

#include <gtest/gtest.h>

namespace octafront::improve {
namespace {

bool is_held(const SurfaceMesh& input, const TriangleCorners& triangle) {
  const TriangleTree tree(input);
  const Features features = detect_features(input, 40);
  FlatWalls walls(input, tree, features);
  return walls.hold({&triangle, 1});
}

TEST(FlatWalls, HoldTheFacesOfABox) {
  EXPECT_TRUE(is_held(testing::box(1, 1, 0.1), {Vec3{0.2, 0.2, 0}, {0.2, 0.3, 0}, {0.3, 0.2, 0}}));
  // What does not lie in the wall is not of it.
  EXPECT_FALSE(is_held(testing::box(1, 1, 0.1), {Vec3{0.2, 0.2, 0}, {0.2, 0.3, 0.01}, {0.3, 0.2, 0}}));
}

TEST(FlatWalls, DoNotHoldFacetsOfASmoothBody) {
  const SurfaceMesh sphere = testing::icosphere(2);
  const auto& [a, b, c] = sphere.triangles[0];
  EXPECT_FALSE(is_held(sphere, {sphere.points[a], sphere.points[b], sphere.points[c]}));
}

TEST(FlatWalls, HoldAPlaneOfManyTrianglesBesideABlend) {
  // As if its rim were blunt: no feature ends the plane, but it has many triangles.
  SurfaceMesh box = testing::cube(8);
  const TriangleTree tree(box);
  const Features none;
  FlatWalls walls(box, tree, none);
  const TriangleCorners inside{Vec3{0.2, 0.2, 0}, {0.2, 0.3, 0}, {0.3, 0.2, 0}};
  EXPECT_TRUE(walls.hold({&inside, 1}));
}

}  // namespace
}  // namespace octafront::improve
