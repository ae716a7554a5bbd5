#include "cad/shapes/part_contacts.h"

#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace octafront::cad {
namespace {

/// A solid as thick as 2.
Solid solid() {
  Solid made;
  made.volume = 10, made.area = 10;
  return made;
}

/// A square of the plane z = `at` from x = `from` on, 4 wide, that looks up or down, of a solid.
Face plane(double at, double from, bool looks_up, std::uint32_t of) {
  Face face;
  face.surface.kind = SurfaceRecord::Kind::kPlane;
  face.surface.frame.origin = {from, 0, at};
  face.high = {4, 4}, face.area = 16, face.is_turned = !looks_up, face.sides = {kNone, of};
  return face;
}

/// A cylinder about an axis along z, turned away from it where it is a hole; `turn`: of a whole one.
Face cylinder(double radius, double low, double high, bool is_hole, std::uint32_t of, double turn = 1) {
  Face face;
  face.surface.kind = SurfaceRecord::Kind::kCylinder, face.surface.radius = radius;
  face.low = {0, low}, face.high = {2 * std::numbers::pi * turn, high};
  face.area = 2 * std::numbers::pi * turn * radius * (high - low), face.is_turned = is_hole, face.sides = {kNone, of};
  return face;
}

CadModel of_two(std::vector<Face> faces) {
  CadModel model;
  model.solids = {solid(), solid()};
  model.faces = std::move(faces);
  return model;
}

TEST(Contacts, AreSharedFacesByPatch) {
  CadModel model = of_two({plane(0, 0, true, 0), plane(1, 0, true, 0), plane(2, 0, true, 0)});
  for (Face& face : model.faces) face.sides = {1, 0};
  model.faces[2].piece = 0;
  model.shared = {{{0, 1}, 0.5, 0.01}};
  const std::vector<Contact> found = contacts_of(model);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].faces, (std::vector<std::uint32_t>{0, 2}));
  EXPECT_EQ(found[0].area, 32);
  EXPECT_EQ(found[1].area, 16);
  for (const Contact& contact : found) EXPECT_EQ(contact.depth, 0.01) << "a fit";
}

TEST(Contacts, AreNearWhereLittleLiesBetweenPlanes) {
  const auto gap = [](Face a, Face b) {
    const std::vector<Contact> found = contacts_of(of_two({std::move(a), std::move(b)}));
    return found.empty() ? 0 : found[0].gap;
  };
  EXPECT_NEAR(gap(plane(0, 0, true, 0), plane(0.25, 1, false, 1)), 0.25, 1e-15);
  EXPECT_EQ(gap(plane(0, 0, true, 0), plane(0.5, 1, false, 1)), 0) << "too far for solids as thick as 2";
  EXPECT_EQ(gap(plane(0, 0, true, 0), plane(0.25, 1, true, 1)), 0) << "both look up";
  EXPECT_EQ(gap(plane(0, 0, false, 0), plane(0.25, 1, true, 1)), 0) << "they look away from each other";
  EXPECT_EQ(gap(plane(0, 0, true, 0), plane(0.25, 5, false, 1)), 0) << "side by side";
  EXPECT_EQ(gap(plane(0, 0, true, 0), plane(0.25, 1, false, 0)), 0) << "a slot in one solid";
  const Contact beside = contacts_of(of_two({plane(0, 0, true, 0), plane(0.25, 1, false, 1)}))[0];
  EXPECT_NEAR(beside.area, 12, 1e-12);
}

TEST(Contacts, AreNearWhereAShaftIsInAHole) {
  const CadModel whole = of_two({cylinder(5, 0, 10, false, 0), cylinder(5.25, 4, 20, true, 1)});
  const std::vector<Contact> one = contacts_of(whole);
  ASSERT_EQ(one.size(), 1U);
  EXPECT_NEAR(one[0].gap, 0.25, 1e-12);
  EXPECT_NEAR(one[0].area, 2 * std::numbers::pi * 5 * 6, 1e-9);
  EXPECT_EQ(shape_in_words(whole, one[0].faces, 2), "cylinder of radius 2.5 and cylinder of radius 2.625");
  const CadModel halves = of_two({cylinder(5, 0, 10, false, 0, .5), cylinder(5, 0, 10, false, 0, .5),
                                  cylinder(5.25, 0, 10, true, 1, .5), cylinder(5.25, 0, 10, true, 1, .5)});
  const std::vector<Contact> of_halves = contacts_of(halves);
  ASSERT_EQ(of_halves.size(), 1U);
  EXPECT_NEAR(of_halves[0].area, 2 * std::numbers::pi * 5 * 10, 1e-9);
  EXPECT_TRUE(contacts_of(of_two({cylinder(5, 0, 10, false, 0), cylinder(5.25, 0, 10, false, 1)})).empty());
  EXPECT_TRUE(contacts_of(of_two({cylinder(5, 0, 10, false, 0), cylinder(4.9, 0, 10, true, 1)})).empty())
      << "an interference is no gap";
}

TEST(Contacts, AreOverlapsWithoutCommonFaces) {
  CadModel model = of_two({});
  model.shared = {{{0, 1}, 3, 0.5}};
  const std::vector<Contact> found = contacts_of(model);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(found[0].faces.empty());
  EXPECT_EQ(found[0].volume, 3);
}

}  // namespace
}  // namespace octafront::cad
