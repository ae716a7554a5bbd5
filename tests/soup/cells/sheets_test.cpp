#include <octafront/error.h>
#include <octafront/inside.h>
#include <octafront/repair.h>

#include "support/named_surfaces.h"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

SurfaceMesh parallelogram(Vec3 a, Vec3 u, Vec3 v) {
  SurfaceMesh made;
  made.points = {a, a + u, a + u + v, a + v};
  made.triangles = {{0, 1, 2}, {0, 2, 3}};
  return made;
}

double area_of_patch(const SurfaceMesh& surface, const std::string& patch) {
  double sum = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& [a, b, c] = surface.triangles[t];
    const auto& p = surface.points;
    if (surface.patch_names[surface.patch_of(t)] == patch) sum += length(cross(p[b] - p[a], p[c] - p[a])) / 2;
  }
  return sum;
}

bool tells(const Complex& complex, const std::string& part) {
  return std::any_of(complex.notes.begin(), complex.notes.end(),
                     [&](const std::string& n) { return n.find(part) != std::string::npos; });
}

TEST(EmbedSheets, WhatLiesOutsideIsCutOffAndSaid) {
  const Complex made = embed_sheets(testing::cube(2), {{"fault", parallelogram({-1, -1, 0.5}, {3, 0, 0}, {0, 3, 0})}});
  EXPECT_NEAR(area_of_patch(made.surface, "fault"), 1, 1e-12);
  EXPECT_EQ(made.volumes, std::vector<double>{1});
  EXPECT_TRUE(tells(made, "8 outside")) << made.notes[0];
  EXPECT_TRUE(find_defects(repair_surface(made.surface)).clean());
}

TEST(EmbedSheets, OneThatDividesABodyMakesNoRegions) {
  const Complex made =
      embed_sheets(testing::cube(2), {{"fault", parallelogram({-1, -1, 0.3}, {3, 0, 0.2}, {0, 3, 0.1})}});
  EXPECT_EQ(made.surface.region_names, std::vector<std::string>{"body"});
  for (std::size_t t = 0; t < made.surface.triangles.size(); ++t)
    if (made.surface.patch_names[made.surface.patch_of(t)] == "fault") {
      EXPECT_EQ(made.surface.sides[t], (Sides{0, 0}));
    }
}

TEST(EmbedSheets, SheetsThatCrossAreDivided) {
  const Complex made =
      embed_sheets(testing::cube(2), {{"a", parallelogram({-1, -1, 0.5}, {3, 0, 0}, {0, 3, 0})},
                                      {"b", parallelogram({0.5, -1, -1}, {0, 3, 0}, {0, 0, 3})},
                                      {"crack", parallelogram({0.2, 0.3, 0.2}, {0.2, 0, 0}, {0, 0.2, 0.1})}});
  EXPECT_NEAR(area_of_patch(made.surface, "a"), 1, 1e-12);
  EXPECT_NEAR(area_of_patch(made.surface, "b"), 1, 1e-12);
  EXPECT_NEAR(area_of_patch(made.surface, "crack"), length(cross(Vec3{0.2, 0, 0}, Vec3{0, 0.2, 0.1})), 1e-12);
  EXPECT_TRUE(find_defects(repair_surface(made.surface)).clean());
}

TEST(EmbedSheets, FacesLookAsTheirSheetDoes) {
  const Complex made =
      embed_sheets(testing::cube(3), {{"down", parallelogram({0.2, 0.2, 0.5}, {0, 0.5, 0}, {0.5, 0, 0})}});
  for (std::size_t t = 0; t < made.surface.triangles.size(); ++t) {
    if (made.surface.patch_names[made.surface.patch_of(t)] != "down") continue;
    const auto& [a, b, c] = made.surface.triangles[t];
    const auto& p = made.surface.points;
    EXPECT_LT(cross(p[b] - p[a], p[c] - p[a]).z, 0);
  }
}

TEST(EmbedSheets, OneThatLiesOnAWallNamesIt) {
  const Complex made =
      embed_sheets(testing::cube(1), {{"spot", parallelogram({0.25, 0.25, 1}, {0.5, 0, 0}, {0, 0.5, 0})}});
  EXPECT_NEAR(area_of_patch(made.surface, "spot"), 0.25, 1e-12);
  EXPECT_TRUE(tells(made, "0.25 on walls"));
  EXPECT_TRUE(find_defects(repair_surface(made.surface)).clean());
}

TEST(EmbedSheets, OneThatLiesOnAnotherIsSaid) {
  const SurfaceMesh wall = parallelogram({0.25, 0.25, 0.5}, {0.5, 0, 0}, {0, 0.5, 0});
  const Complex made = embed_sheets(testing::cube(1), {{"first", wall}, {"second", wall}});
  EXPECT_NEAR(area_of_patch(made.surface, "first"), 0.25, 1e-12);
  EXPECT_TRUE(tells(made, "the sheet second: area 0 inside, 0.25 on earlier sheets"));
}

TEST(EmbedSheets, WithinTheToleranceAnEdgeComesOntoTheWall) {
  const Complex made =
      embed_sheets(testing::cube(1), {{"rib", parallelogram({0.5, 1e-7, 0.25}, {0, 0.5, 0}, {0, 0, 0.5})}});
  EXPECT_EQ(std::count_if(made.surface.points.begin(), made.surface.points.end(),
                          [](Vec3 p) { return p.x == 0.5 && p.y == 0 && p.z != 0.5; }),
            2);
}

TEST(EmbedSheets, OneOutsideOfEverythingIsRefusedByName) {
  try {
    embed_sheets(testing::cube(1), {{"far", parallelogram({5, 5, 5}, {1, 0, 0}, {0, 1, 0})}});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("far"), std::string::npos);
  }
}

}  // namespace
}  // namespace octafront
