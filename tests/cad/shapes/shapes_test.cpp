#include "cad/shapes/shapes.h"

#include "../half_pipe.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace octafront::cad {
namespace {

using Patches = std::array<std::uint32_t, 2>;

Shapes apart() {
  CadModel model = half_pipe(4);
  FaceGroups groups = group_faces(model, std::nullopt);
  return {std::move(model), std::move(groups)};
}

TEST(Shapes, PutPointsOnFaces) {
  const Shapes shapes = apart();
  const auto on = shapes.on_face(0, {0.9 * std::cos(0.5), 0.9 * std::sin(0.5), 1});
  ASSERT_TRUE(on);
  EXPECT_LT(distance(*on, {std::cos(0.5), std::sin(0.5), 1}), 1e-15);
  EXPECT_LT(distance(*shapes.on_face(2, {2, 0.1, 1}), {2, 0, 1}), 1e-15);
}

TEST(Shapes, PutPointsOnEdgesOfThesePatchesOnly) {
  const Shapes shapes = apart();
  const auto between = shapes.on_edge(Patches{0, 1}, {0.1, 0.9, 3});
  ASSERT_TRUE(between);
  EXPECT_LT(distance(*between, {0, 1, 3}), 1e-15);
  EXPECT_LT(distance(*shapes.on_edge(Patches{0, 2}, {0.1, 0.9, 3}), {1, 0, 3}), 1e-15);
  EXPECT_FALSE(shapes.on_edge(Patches{1, 2}, {0.1, 0.9, 3}));
}

TEST(Shapes, KnowVerticesBitForBit) {
  const Shapes shapes = apart();
  EXPECT_TRUE(shapes.is_vertex({0, 1, 4}));
  EXPECT_FALSE(shapes.is_vertex({0, std::nextafter(1, 2), 4}));
}

TEST(Shapes, NameThePartsOfAGroup) {
  CadModel model = half_pipe(4);
  FaceGroups groups = group_faces(model, 3);
  const Shapes shapes(std::move(model), std::move(groups));
  ASSERT_EQ(shapes.patch_names().size(), 2u);
  EXPECT_EQ(shapes.part_at(0, {0.8, 0.6, 2}), 0u);
  EXPECT_EQ(shapes.part_at(0, {-0.8, 0.6, 2}), 1u);
  EXPECT_EQ(shapes.part_names()[1], "left");
  EXPECT_FALSE(shapes.on_edge(Patches{0, 0}, {0, 1, 2}));
}

TEST(Shapes, TakeAndGivePointsInAUnit) {
  CadModel model = half_pipe(4);
  const Vec3 corner = model.points[model.vertices[0]];
  FaceGroups groups = group_faces(model, std::nullopt);
  const Shapes inches(std::move(model), std::move(groups), 25.4);
  const auto on = inches.on_face(0, Vec3{0.9 * std::cos(0.5), 0.9 * std::sin(0.5), 1} / 25.4);
  ASSERT_TRUE(on);
  EXPECT_LT(distance(25.4 * *on, {std::cos(0.5), std::sin(0.5), 1}), 1e-14);
  EXPECT_LT(distance(25.4 * *inches.on_edge(Patches{0, 1}, Vec3{0.1, 0.9, 3} / 25.4), {0, 1, 3}), 1e-14);
  EXPECT_EQ(inches.part_at(0, Vec3{0.8, 0.6, 2} / 25.4), 0u);
  EXPECT_TRUE(inches.is_vertex(corner / 25.4));
}

TEST(Shapes, KnowGroupsByPartsAndRegions) {
  CadModel model = half_pipe(4);
  model.solids.resize(1);
  model.solids[0].labels = {"pipe", "L1", {}};
  model.faces[1].labels.layer = "inside";
  FaceGroups groups = group_faces(model, 3);
  const Shapes shapes(std::move(model), std::move(groups));
  ASSERT_EQ(shapes.groups().size(), 2u);
  EXPECT_EQ(shapes.groups()[0].name, "layer inside");
  EXPECT_EQ(shapes.groups()[0].parts, std::vector<std::uint32_t>{1});
  EXPECT_EQ(shapes.groups()[1].name, "solids of layer L1");
  EXPECT_EQ(shapes.groups()[1].regions, std::vector<std::string>{"pipe"});
  EXPECT_EQ(shapes.patch_of_part(1), 0u);
}

}  // namespace
}  // namespace octafront::cad
