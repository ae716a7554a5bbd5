#include <octafront/error.h>
#include <octafront/named_groups.h>
#include <octafront/surface_mesh.h>
#include <octafront/validity.h>

#include "support/rich_mesh.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace octafront {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using Kind = NamedSet::Kind;

TEST(AddGroup, TakesWhatLiesInABoxOrBall) {
  TetMesh mesh = testing::with_mid_nodes(testing::rich_mesh(4));
  mesh.sets.clear();
  const Box3 half{{0, 0, 0}, {2, 4, 4}};
  EXPECT_EQ(add_group(mesh, {"n", Kind::kNodes, half}), "");
  EXPECT_EQ(mesh.sets[0].members.size(), 5U * 9 * 9);  // corners and mid-side nodes at x = 0, .5 ... 2
  add_group(mesh, {"e", Kind::kElements, half});
  EXPECT_EQ(mesh.sets[1].members.size(), mesh.tets.size() / 2);
  add_group(mesh, {"f", Kind::kFaces, half});
  EXPECT_EQ(mesh.sets[2].members.size(), 32U + 4 * 16 + 32);  // an end, half of four sides, the interface
  add_group(mesh, {"b", Kind::kNodes, GroupRule::Sphere{{4, 4, 4}, 0.5}});
  EXPECT_EQ(mesh.sets[3].members.size(), 4U);
  EXPECT_EQ(first_defect(mesh), std::nullopt);
}

TEST(AddGroup, TakesPatchesByNameOrNumber) {
  TetMesh mesh = testing::rich_mesh(2);
  mesh.sets.clear();
  EXPECT_EQ(add_group(mesh, {"g", Kind::kFaces, std::vector<std::string>{"load-1", "1", "glue"}}), "");
  EXPECT_EQ(mesh.sets[0].members.size(), 8U * 3);
}

TEST(AddGroup, SaysWhatIsNotThere) {
  TetMesh mesh = testing::rich_mesh(2);
  mesh.sets.clear();
  for (const char* patch : {"lid", "99"}) try {
      add_group(mesh, {"g", Kind::kFaces, std::vector<std::string>{"glue", patch}});
      FAIL() << patch;
    } catch (const OptionError& error) {
      EXPECT_THAT(error.what(), AllOf(HasSubstr(patch), HasSubstr("glue")));
    }
  EXPECT_THAT(add_group(mesh, {"far", Kind::kNodes, Box3{{9, 9, 9}, {10, 10, 10}}}), HasSubstr("nothing lies there"));
  EXPECT_TRUE(mesh.sets.empty());
}

TEST(AddGroup, HoldsWhatHasAName) {
  TetMesh mesh = testing::rich_mesh(2);
  mesh.sets.clear();
  EXPECT_EQ(add_group(mesh, group_rule("g=glue")), "");
  EXPECT_EQ(mesh.sets[0].kind, Kind::kFaces);
  EXPECT_EQ(mesh.sets[0].members.size(), 8U);
  EXPECT_EQ(add_group(mesh, group_rule("e=elements:box:0,0,0,1,2,2")), "");
  EXPECT_EQ(mesh.sets[1].members.size(), mesh.tets.size() / 2);
  EXPECT_THAT(add_group(mesh, group_rule("g=lid")), HasSubstr("it is left out"));
  for (const char* bad : {"g", "=glue", "g=", "g=elements:glue", "g=bxo:1,2", "g=box:1,2"})
    EXPECT_THROW(group_rule(bad), OptionError) << bad;
}

TEST(AddGroup, IsCheckedOnTheSurfaceBefore) {
  SurfaceMesh cube;
  cube.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  cube.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  cube.patch = {0, 0, 0, 1};
  cube.patch_names = {"", "lid", "of no triangle"};
  cube.sides.assign(4, {kNone, 1});
  cube.region_names = {"air", "bone"};
  for (const char* good : {"g=patches:lid,bone", "g=patches:lid_plus", "g=patches:3", "g=bone"})
    EXPECT_NO_THROW(check_group(cube, group_rule(good))) << good;
  for (const char* bad : {"g=patches:lib", "g=patches:lid,of no triangle"})
    EXPECT_THROW(check_group(cube, group_rule(bad)), OptionError) << bad;
}

TEST(AddBins, DividesTheRangeOfAField) {
  TetMesh mesh = testing::rich_mesh(2);
  mesh.sets.clear();
  MeshField field{"E", true, 1, std::vector<double>(mesh.tets.size(), 10)};
  field.values[3] = 0, field.values[4] = 4, field.values[5] = 100;
  const auto bins = add_bins(mesh, field, 10);
  ASSERT_EQ(bins.size(), 3u);
  EXPECT_EQ(bins[0].set, "E_01");
  EXPECT_EQ(bins[0].elements, 2u);
  EXPECT_EQ(bins[0].mean, 2);
  EXPECT_EQ(bins[1].set, "E_02");
  EXPECT_EQ(bins[2].set, "E_10");
  EXPECT_EQ(bins[2].most, 100);
  EXPECT_EQ(mesh.sets[0].members, (std::vector<std::uint32_t>{3, 4}));
  EXPECT_EQ(mesh.sets[2].members, (std::vector<std::uint32_t>{5}));
  field.values.assign(mesh.tets.size(), 7);
  EXPECT_EQ(add_bins(mesh, field, 3).size(), 1u);
}

TEST(PatchCurves, AreWherePatchesMeet) {
  TetMesh mesh = testing::rich_mesh(4);
  const TetMesh wanted = mesh;
  mesh.curve_edges.clear();
  mesh.curve.clear();
  mesh.curve_names.clear();
  add_patch_curves(mesh);
  // The edges of the box, and those where the wall inside meets four of its sides.
  EXPECT_EQ(mesh.curve_edges.size(), wanted.curve_edges.size() + 4 * 4);
  EXPECT_EQ(1 + *std::max_element(mesh.curve.begin(), mesh.curve.end()), 12U + 4);
  EXPECT_EQ(std::count(mesh.curve_names.begin(), mesh.curve_names.end(), "fixed end|y_max"), 1);
  EXPECT_EQ(std::count(mesh.curve_names.begin(), mesh.curve_names.end(), ""), 4 + 1);  // of the patch without a name
}

}  // namespace
}  // namespace octafront
