#include "base/places/places.h"

#include <octafront/error.h>

#include "base/mesh/known_surface.h"
#include "support/named_surfaces.h"
#include "support/rich_mesh.h"

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

TEST(Places, OfASurfaceWithoutNamesAreCalledAsFilesCallThem) {
  const KnownSurface cube(testing::cube(2), 40);
  const SurfacePlaces places(cube.mesh(), &cube.edges());
  const auto at = [&](const std::string& text) { return places.at("size_of", place_of("size_of", text)); };
  EXPECT_THAT(at("patch_3").triangles, SizeIs(8));
  EXPECT_EQ(at("3").triangles, at("patch_3").triangles);
  EXPECT_THAT(at("patches:patch_3,4").triangles, SizeIs(16));
  EXPECT_EQ(at("body").region, 0U);
  EXPECT_EQ(at("region 1").region, 0U);
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
