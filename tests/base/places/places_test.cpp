#include "base/places/places.h"

#include <octafront/error.h>

#include "base/mesh/known_surface.h"
#include "base/places/shape_place.h"
#include "support/named_surfaces.h"
#include "support/rich_mesh.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace octafront {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using ::testing::ThrowsMessage;
using Texts = std::vector<std::string>;

Texts texts_of(const std::vector<Place>& places) {
  Texts texts;
  for (const Place& place : places) texts.push_back(place.text);
  return texts;
}

TEST(Places, AreReadInOneLanguage) {
  EXPECT_EQ(std::get<std::string>(place_of("on", "lid").where), "lid");
  EXPECT_EQ(std::get<Texts>(place_of("on", "patches:a,3").where), (Texts{"a", "3"}));
  EXPECT_EQ(std::get<Box3>(place_of("on", "box:1,2,3,0,0, 0").where).hi, (Vec3{1, 2, 3}));
  EXPECT_EQ(std::get<GroupRule::Sphere>(place_of("on", "sphere:1,2,3,4").where).radius, 4);
  for (const char* bad : {"box:1,2", "box:1,2,3,4,5,x", "sphere:0,0,0,0", "sphere:0,0,0,-1", "box:1,2,3,4,5,inf"})
    EXPECT_THAT([&] { place_of("on", bad); }, ThrowsMessage<OptionError>(HasSubstr(bad))) << bad;
}

TEST(Places, OfAListMayHoldItsSeparator) {
  const Texts known{"wall", "left, upper", "lid"};
  EXPECT_EQ(texts_of(places_listed("on", "wall,left, upper,lid", ',', known)), known);
  EXPECT_EQ(texts_of(places_listed("on", ",wall,box:0,0,0,1,1,1,sphere:1,1,1,2,lid,", ',', known)),
            (Texts{"wall", "box:0,0,0,1,1,1", "sphere:1,1,1,2", "lid"}));
  EXPECT_EQ(texts_of(places_listed("only", "box:0,0,0,1,1,1;lid", ';', {})), (Texts{"box:0,0,0,1,1,1", "lid"}));
  EXPECT_THAT(places_listed("on", "", ',', {}), SizeIs(0));
}

TEST(Places, OfPatchesAreNamesThenSharesOfANameThenNumbers) {
  const Texts names{"fault (a|b)", "fault (b|c)", "", "3", "gone"};
  const std::vector<char> is_there{1, 1, 1, 1, 0};
  EXPECT_THAT(patches_called(names, is_there, "fault (b|c)"), ElementsAre(1));
  EXPECT_THAT(patches_called(names, is_there, "fault"), ElementsAre(0, 1));
  EXPECT_THAT(patches_called(names, is_there, "patch_3"), ElementsAre(2));
  EXPECT_THAT(patches_called(names, is_there, "3"), ElementsAre(3)) << "a name goes before a number";
  EXPECT_THAT(patches_called(names, is_there, "2"), ElementsAre(1));
  for (const char* none : {"gone", "5", "patch_2", "0", "-1", "", "fault ("})
    EXPECT_THAT(patches_called(names, is_there, none), SizeIs(0)) << none;
}

TEST(Places, OfANameAreItsPiecesToo) {
  const Texts names{"wall", "wall#2", "wall#x", "a|b", "a|b#2", "a|b#10", "walls"};
  EXPECT_THAT(named_so(names, "wall"), ElementsAre(0, 1));
  EXPECT_THAT(named_so(names, "wall#1"), ElementsAre(0)) << "the first alone";
  EXPECT_THAT(named_so(names, "wall#2"), ElementsAre(1));
  EXPECT_THAT(named_so(names, "a|b"), ElementsAre(3, 4, 5));
  EXPECT_THAT(named_so(names, "b|a"), ElementsAre(3, 4, 5)) << "whichever is written first";
  EXPECT_THAT(named_so(names, "b|a#2"), SizeIs(0)) << "b and a#2";
  for (const char* none : {"", "wall#", "wall#3", "#2", "b", "a|b|"})
    EXPECT_THAT(named_so(names, none), SizeIs(0)) << none;
  for (const std::string& name : names) EXPECT_THAT(named_so(names, alone(names, name)), SizeIs(1)) << name;
  EXPECT_EQ(alone(names, "walls"), "walls");
}

TEST(Places, OfRegionsMeanAllOfAName) {
  SurfaceMesh two = testing::joined(testing::cube(), testing::transformed(testing::cube(), 1, {3, 0, 0}));
  two.sides.assign(two.triangles.size(), {kNone, 0});
  std::fill(two.sides.begin() + 12, two.sides.end(), Sides{kNone, 1});
  two.region_names = {"bolt", "bolt#2"};
  const SurfacePlaces places(two);
  EXPECT_THAT(places.at("in", place_of("in", "bolt")).regions, ElementsAre(0, 1));
  EXPECT_THAT(places.at("in", place_of("in", "bolt#1")).regions, ElementsAre(0));
  EXPECT_THAT(places.at("in", place_of("in", "bolt#2")).regions, ElementsAre(1));
}

TEST(Places, SayWhatSomethingIsLike) {
  using ShapeKind = ShapePlace::Kind;
  const auto kind = [](const char* text) {
    const std::optional<ShapePlace> place = shape_place_of(text);
    return place ? std::optional(place->kind) : std::nullopt;
  };
  EXPECT_EQ(kind("plane"), ShapeKind::kPlanes);
  EXPECT_EQ(kind("free faces"), ShapeKind::kFreeFaces);
  EXPECT_EQ(kind("tori of radius 2"), ShapeKind::kTori);
  EXPECT_EQ(kind("points at y max"), ShapeKind::kPoints);
  const std::optional<ShapePlace> all = shape_place_of("largest cylinder of radius 2.5e1 of lower plate at z min");
  ASSERT_TRUE(all);
  EXPECT_EQ(all->kind, ShapeKind::kCylinders);
  EXPECT_EQ(all->which, ShapePlace::Which::kLargest);
  EXPECT_EQ(all->radius, 25);
  EXPECT_EQ(all->of, "lower plate");
  EXPECT_EQ(all->axis, 2);
  EXPECT_FALSE(all->at_max);
  for (const char* none :
       {"", "wall", "planets", "plane 3", "planes of radius 3", "cylinders of radius -1", "cylinders of radius x",
        "largest", "largest points", "plane at w min", "plane at z", "cylinder ofradius 3"})
    EXPECT_FALSE(shape_place_of(none)) << none;
}

TEST(Places, OfASurfaceWithoutNamesAreCalledAsFilesCallThem) {
  const KnownSurface cube(testing::cube(2), 40);
  const SurfacePlaces places(cube.mesh(), &cube.edges());
  const auto at = [&](const std::string& text) { return places.at("size_of", place_of("size_of", text)); };
  EXPECT_THAT(at("patch_3").triangles, SizeIs(8));
  EXPECT_EQ(at("3").triangles, at("patch_3").triangles);
  EXPECT_THAT(at("patches:patch_3,4").triangles, SizeIs(16));
  EXPECT_THAT(at("body").regions, ElementsAre(0U));
  EXPECT_THAT(at("region 1").regions, ElementsAre(0U));
  EXPECT_THAT(at("patch_1|patch_3").edges, SizeIs(2));
  EXPECT_THAT(at("box:0,0,0,1,1,0").triangles, SizeIs(8));
  EXPECT_THAT(at("sphere:0,0,0,1e-9").triangles, SizeIs(0));
  EXPECT_THAT([&] { at("lid"); },
              ThrowsMessage<OptionError>(AllOf(HasSubstr("no region, patch or curve \"lid\""), HasSubstr("\"body\""),
                                               HasSubstr("\"patch_6\""), HasSubstr("\"patch_1|patch_3\""))));
}

TEST(Places, OfAMeshAreNamesOrWhatFilesCallThem) {
  TetMesh mesh = testing::rich_mesh(2);
  const auto at = [&](const std::string& text) { return items_at(mesh, "only", place_of("only", text)); };
  EXPECT_THAT(at("glue").faces, SizeIs(8));
  EXPECT_EQ(at("patches:glue,1").faces.size(), 16U);
  mesh.patch_names.clear(), mesh.region_names.clear(), mesh.curve_names.clear(), mesh.sets.clear();
  EXPECT_EQ(at("patch_2").faces, at("2").faces);
  EXPECT_EQ(at("body_2").tets.size(), mesh.tets.size() / 2);
  EXPECT_EQ(at("curve_1").edges.size(), mesh.curve_edges.size() / 12);
  EXPECT_EQ(at("box:0,0,0,2,2,2").tets.size(), mesh.tets.size());
  EXPECT_THAT([&] { at("lid"); }, ThrowsMessage<OptionError>(AllOf(HasSubstr("no region, patch, curve or set \"lid\""),
                                                                   HasSubstr("\"body_2\""), HasSubstr("\"patch_7\""))));
}

}  // namespace
}  // namespace octafront
