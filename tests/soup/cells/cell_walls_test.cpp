#include <octafront/complex.h>
#include <octafront/repair.h>

#include "support/complexes.h"
#include "support/named_surfaces.h"
#include "support/nasty_surfaces.h"
#include "support/random.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

SurfaceMesh walls_of(const testing::KnownComplex& known) {
  SurfaceMesh walls = known.surface;
  walls.sides.clear();
  walls.region_names.clear();
  return walls;
}

std::vector<double> sorted(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values;
}

void expect_volumes(const std::vector<double>& found, const std::vector<double>& wanted) {
  ASSERT_EQ(found.size(), wanted.size());
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(sorted(found)[i], sorted(wanted)[i], 1e-12);
}

bool has_note(const Complex& complex, const std::string& part) {
  return std::any_of(complex.notes.begin(), complex.notes.end(),
                     [&](const std::string& n) { return n.find(part) != std::string::npos; });
}

TEST(ComplexOfWalls, FindsEveryKnownComplexFromItsWalls) {
  for (const testing::KnownComplex& known : testing::known_complexes()) {
    SCOPED_TRACE(known.name);
    ComplexOptions options;
    // Bodies that meet in an edge or a vertex only are one region, unless somebody asks.
    const auto is_inner = [](const Sides& s) { return s[0] != kNone && s[1] != kNone; };
    if (std::none_of(known.surface.sides.begin(), known.surface.sides.end(), is_inner))
      options.cells = ComplexOptions::Cells::kRegions;
    const auto complex = complex_of_walls(walls_of(known), options);
    ASSERT_TRUE(complex);
    expect_volumes(complex->volumes, known.volumes);
    expect_volumes(testing::region_volumes(complex->surface), known.volumes);
    EXPECT_EQ(complex->surface.triangles.size(), known.surface.triangles.size());
  }
}

TEST(ComplexOfWalls, ASheetStays) {
  const testing::KnownComplex known = testing::buried_crack();
  const auto complex = complex_of_walls(walls_of(known));
  ASSERT_TRUE(complex);
  EXPECT_EQ(std::count(complex->surface.sides.begin(), complex->surface.sides.end(), Sides{0, 0}), 2);
  EXPECT_TRUE(has_note(*complex, "sheets"));
}

TEST(ComplexOfWalls, PlainSurfacesStayPlain) {
  EXPECT_FALSE(complex_of_walls(testing::icosphere(2)));
  EXPECT_FALSE(complex_of_walls(testing::hollow_sphere(2)));
  EXPECT_FALSE(
      complex_of_walls(testing::joined(testing::cube(1), testing::transformed(testing::cube(1), 1, {3, 0, 0}))));
  // What cannot be meshed is refused by those who mesh it.
  SurfaceMesh open = testing::cube(1);
  open.triangles.pop_back();
  open.patch.clear();
  EXPECT_FALSE(complex_of_walls(open));
  EXPECT_FALSE(
      complex_of_walls(testing::joined(testing::cube(1), testing::transformed(testing::cube(1), 1, {.5, .5, .5}))));
}

TEST(ComplexOfWalls, ShellsInsideOthersByDirection) {
  const SurfaceMesh outer = testing::cube(2), inner = testing::transformed(testing::cube(1), 0.5, {.25, .25, .25});
  const auto region = complex_of_walls(testing::joined(outer, inner));
  ASSERT_TRUE(region);
  expect_volumes(region->volumes, {0.875, 0.125});
  EXPECT_TRUE(has_note(*region, "facing outward"));
  EXPECT_FALSE(complex_of_walls(testing::joined(outer, testing::reversed(inner)))) << "a cavity, as ever";

  ComplexOptions options;
  options.nested = ComplexOptions::Nested::kCavity;
  const auto cavity = complex_of_walls(testing::joined(outer, inner), options);
  ASSERT_TRUE(cavity);
  expect_volumes(cavity->volumes, {0.875});
  EXPECT_TRUE(cavity->surface.sides.empty()) << "one region alone is a plain surface";
  options.nested = ComplexOptions::Nested::kRegion;
  const auto filled = complex_of_walls(testing::joined(outer, testing::reversed(inner)), options);
  ASSERT_TRUE(filled);
  expect_volumes(filled->volumes, {0.875, 0.125});
}

/// Solids that touch themselves in edges and vertices, with the number of cavities.
struct Touching {
  const char* name;
  SurfaceMesh surface;
  std::uint32_t cavities;
};

std::vector<std::array<int, 3>> cubes_of_even_sum(int n) {
  std::vector<std::array<int, 3>> cubes = testing::all_cubes_but(n, {});
  std::erase_if(cubes, [](const auto& c) { return (c[0] + c[1] + c[2]) % 2 != 0; });
  return cubes;
}

/// Around a cube that is not there, each a body by itself that faces outward.
SurfaceMesh six_cubes() {
  SurfaceMesh all;
  for (const Vec3 at : {Vec3{0, 1, 1}, Vec3{2, 1, 1}, Vec3{1, 0, 1}, Vec3{1, 2, 1}, Vec3{1, 1, 0}, Vec3{1, 1, 2}})
    all = testing::joined(std::move(all), testing::transformed(testing::cube(1), 1, at));
  return all;
}

/// A cube in a cavity that has one edge in common with the cavity's wall.
SurfaceMesh cube_in_cavity() {
  std::vector<std::array<int, 3>> gaps;
  for (int i = 0; i < 27; ++i) gaps.push_back({1 + i % 3, 1 + i / 3 % 3, 1 + i / 9});
  std::erase_if(gaps, [](const auto& c) { return c[2] == 2 && c[0] == c[1] && c[0] < 3; });
  return testing::boundary_of_cubes(5, testing::all_cubes_but(5, gaps));
}

std::vector<Touching> touching_solids() {
  using testing::all_cubes_but, testing::boundary_of_cubes;
  return {{"cavity and notch with one edge", boundary_of_cubes(4, all_cubes_but(4, {{1, 1, 1}, {0, 0, 1}})), 1},
          {"cavity and notch with one vertex", boundary_of_cubes(4, all_cubes_but(4, {{1, 1, 1}, {0, 0, 0}})), 1},
          {"two cavities with one edge", boundary_of_cubes(4, all_cubes_but(4, {{1, 1, 1}, {2, 2, 1}})), 2},
          {"cube in a cavity", cube_in_cavity(), 1},
          {"cubes with one edge", boundary_of_cubes(2, {{0, 0, 0}, {1, 1, 0}}), 0},
          {"cubes with one vertex", boundary_of_cubes(2, {{0, 0, 0}, {1, 1, 1}}), 0},
          {"cubes around a void", six_cubes(), 1},
          {"checkerboard", boundary_of_cubes(4, cubes_of_even_sum(4)), 4}};
}

TEST(ComplexOfWalls, WhatTouchesItselfInEdgesIsOneRegionAndCavitiesStayEmpty) {
  for (const Touching& solid : touching_solids())
    for (const auto cells : {ComplexOptions::Cells::kAuto, ComplexOptions::Cells::kMerge}) {
      SCOPED_TRACE(solid.name);
      ComplexOptions options;
      options.cells = cells;
      const auto complex = complex_of_walls(solid.surface, options);
      ASSERT_TRUE(complex);
      expect_volumes(complex->volumes, {enclosed_volume(solid.surface)});
      EXPECT_EQ(complex->surface.region_names, (std::vector<std::string>{"body"}));
      EXPECT_EQ(bounded_spaces(complex->surface).cavities, solid.cavities);
      EXPECT_EQ(has_note(*complex, "empty"), solid.cavities > 0);
      EXPECT_TRUE(find_defects(repair_surface(complex->surface)).clean());
    }
}

TEST(ComplexOfWalls, TheSameTurnedInsideOutOrFacingAnyWay) {
  testing::Random random(7);
  for (const Touching& solid : touching_solids()) {
    SCOPED_TRACE(solid.name);
    const double volume = enclosed_volume(solid.surface);
    SurfaceMesh any_way = solid.surface, slip = solid.surface;
    for (Triangle& t : any_way.triangles)
      if (random.unit() < 0.5) std::swap(t[1], t[2]);
    std::swap(slip.triangles[3][1], slip.triangles[3][2]);
    for (const SurfaceMesh& walls : {testing::reversed(solid.surface), any_way, slip}) {
      const auto complex = complex_of_walls(walls);
      ASSERT_TRUE(complex);
      expect_volumes(complex->volumes, {volume});
      EXPECT_EQ(bounded_spaces(complex->surface).cavities, solid.cavities);
    }
  }
}

TEST(ComplexOfWalls, VoxelsOfAllKindsKeepTheirVolume) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    const SurfaceMesh voxels =
        testing::random_voxels(5, 0.1 * static_cast<double>(1 + seed % 9), 0, testing::Pinches::kKept, seed);
    const auto complex = complex_of_walls(voxels);
    EXPECT_NEAR(enclosed_volume(complex ? complex->surface : voxels), enclosed_volume(voxels), 1e-12);
  }
}

TEST(ComplexOfWalls, NestedRegionFillsWhatIsEnclosedAndRegionsAreApart) {
  const SurfaceMesh cavity = testing::boundary_of_cubes(4, testing::all_cubes_but(4, {{1, 1, 1}, {0, 0, 1}}));
  ComplexOptions options;
  options.nested = ComplexOptions::Nested::kRegion;
  const auto filled = complex_of_walls(cavity, options);
  ASSERT_TRUE(filled);
  expect_volumes(filled->volumes, {62, 1});
  ComplexOptions regions;
  regions.cells = ComplexOptions::Cells::kRegions;
  const auto cubes = complex_of_walls(six_cubes(), regions);
  ASSERT_TRUE(cubes);
  expect_volumes(cubes->volumes, {1, 1, 1, 1, 1, 1});
}

TEST(ComplexOfWalls, SeedsNameAndEmpty) {
  const testing::KnownComplex known = testing::stacked_layers({1, 0.5, 0.25});
  ComplexOptions options;
  options.regions = {{"rock", {.3, .4, .5}}, {"sand", {.3, .4, 1.25}}};
  options.voids = {{.3, .4, 1.6}};
  const auto complex = complex_of_walls(walls_of(known), options);
  ASSERT_TRUE(complex);
  EXPECT_EQ(complex->surface.region_names, (std::vector<std::string>{"rock", "sand"}));
  EXPECT_NEAR(complex->volumes[0], 1, 1e-12);
  EXPECT_NEAR(complex->volumes[1], 0.5, 1e-12);
  // The same for a complex that knows its sides.
  const auto again = complex_of_walls(known.surface, options);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->surface.region_names, complex->surface.region_names);
  expect_volumes(again->volumes, complex->volumes);
}

TEST(ComplexOfWalls, MergeTakesTheWallsAway) {
  ComplexOptions options;
  options.cells = ComplexOptions::Cells::kMerge;
  const auto complex = complex_of_walls(walls_of(testing::foam(20, 1)), options);
  ASSERT_TRUE(complex);
  EXPECT_TRUE(complex->surface.sides.empty());
  EXPECT_NEAR(enclosed_volume(complex->surface), 1, 1e-12);
}

TEST(ComplexOfWalls, CrossingWallsAreDividedWhereAsked) {
  const SurfaceMesh two = testing::joined(testing::cube(1), testing::transformed(testing::cube(1), 1, {.5, .5, .5}));
  ComplexOptions options;
  options.cells = ComplexOptions::Cells::kRegions;
  const auto complex = complex_of_walls(two, options);
  ASSERT_TRUE(complex);
  expect_volumes(complex->volumes, {0.875, 0.125, 0.875});
}

TEST(ComplexOfWalls, ALeakSaysWhere) {
  testing::KnownComplex known = testing::stacked_layers({1, 1});
  SurfaceMesh walls = walls_of(known);
  ComplexOptions options;
  options.regions = {{"low", {.3, .4, .5}}, {"high", {.3, .4, 1.5}}};
  // Of the wall between both, and of the outside.
  for (const Sides hole : {Sides{1, 0}, Sides{kNone, 0}}) {
    SurfaceMesh leaky = walls;
    const auto at =
        std::find(known.surface.sides.begin(), known.surface.sides.end(), hole) - known.surface.sides.begin();
    leaky.triangles.erase(leaky.triangles.begin() + at);
    leaky.patch.clear();
    try {
      complex_of_walls(leaky, options);
      FAIL() << "the leak is not seen";
    } catch (const LeakError& leak) {
      EXPECT_GT(leak.way.size(), 2U);
      EXPECT_NE(std::string(leak.what()).find("low"), std::string::npos) << leak.what();
      EXPECT_FALSE(tube_along(leak.way).triangles.empty());
    }
  }
}

TEST(ComplexOfWalls, SeedsOutsideAndOnFacesAreRefused) {
  ComplexOptions options;
  options.regions = {{"a", {5, 5, 5}}};
  try {
    complex_of_walls(testing::cube(2), options);
    FAIL();
  } catch (const LeakError&) {
    FAIL() << "nothing leaks";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("outside"), std::string::npos);
  }
  options.regions = {{"a", {0.5, 0.5, 1}}};
  EXPECT_THROW(complex_of_walls(testing::cube(2), options), InputError);
}

}  // namespace
}  // namespace octafront
