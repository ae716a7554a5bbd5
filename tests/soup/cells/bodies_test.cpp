#include <octafront/complex.h>

#include "base/geometry/self_intersection.h"
#include "support/complexes.h"
#include "support/named_surfaces.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace octafront {
namespace {

std::vector<Body> bodies_of(const testing::KnownParts& known) {
  std::vector<Body> bodies;
  for (std::size_t i = 0; i < known.parts.size(); ++i) bodies.push_back({known.names[i], known.parts[i]});
  return bodies;
}

void expect_joined(const Complex& complex, const testing::KnownParts& known, double tolerance) {
  EXPECT_EQ(complex.surface.region_names, known.names);
  ASSERT_EQ(complex.volumes.size(), known.volumes.size());
  for (std::size_t r = 0; r < known.volumes.size(); ++r) {
    EXPECT_NEAR(complex.volumes[r], known.volumes[r], tolerance);
    EXPECT_NEAR(testing::region_volumes(complex.surface)[r], known.volumes[r], tolerance);
  }
  EXPECT_TRUE(self_intersections(complex.surface.points, complex.surface.triangles).empty());
}

double interface_area(const SurfaceMesh& s) {
  double area = 0;
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    if (s.sides[t][0] == kNone || s.sides[t][1] == kNone) continue;
    const auto [a, b, c] = s.triangles[t];
    area += length(cross(s.points[b] - s.points[a], s.points[c] - s.points[a])) / 2;
  }
  return area;
}

TEST(JoinBodies, KnownParts) {
  for (const testing::KnownParts& known : testing::known_parts()) {
    SCOPED_TRACE(known.name);
    expect_joined(join_bodies(bodies_of(known)), known, 1e-9);
  }
}

TEST(JoinBodies, ABoltSharesItsHoleWithThePlate) {
  const testing::KnownParts known = testing::bolt_in_hole(32, false);
  const Complex complex = join_bodies(bodies_of(known));
  const double side = 2 * 0.5 * std::sin(std::acos(-1) / 32);
  EXPECT_NEAR(interface_area(complex.surface), 32 * side * 0.375, 1e-9);
}

TEST(JoinBodies, GapsBelowTheToleranceClose) {
  // Boxes with a gap, with an overlap, and with single precision between them; their sides divided in different ways.
  const SurfaceMesh low = testing::box(1, 1, 1, 2);
  for (const double gap : {1e-4, -1e-4, 3e-8, 0.0}) {
    SCOPED_TRACE(gap);
    SurfaceMesh high = testing::box(1, 1, 1, 3);
    for (Vec3& p : high.points) p = {p.x + gap, p.y - gap, p.z + 1 + gap};
    ComplexOptions options;
    options.tolerance = 1e-3;
    const Complex complex = join_bodies({{"low", low}, {"high", high}}, options);
    EXPECT_NEAR(interface_area(complex.surface), 1, 1e-3);
    EXPECT_TRUE(self_intersections(complex.surface.points, complex.surface.triangles).empty());
    ASSERT_EQ(complex.volumes.size(), 2U);
    EXPECT_NEAR(complex.volumes[0], 1, 1e-9) << "earlier bodies stay where they are";
    EXPECT_NEAR(complex.volumes[1], 1, 1e-3);
    for (const Vec3 p : low.points)
      EXPECT_NE(std::find(complex.surface.points.begin(), complex.surface.points.end(), p),
                complex.surface.points.end());
    options.tolerance = 0;
    EXPECT_NEAR(interface_area(join_bodies({{"low", low}, {"high", high}}, options).surface), gap == 0 ? 1 : 0,
                gap < 0 ? 1.1 : 1e-9);
  }
}

TEST(JoinBodies, ATurnedBoxOnAnother) {
  // Their faces touch at an angle that no lattice knows: vertices of one lie amid triangles of the other, edges cross.
  const double c = std::cos(0.3), s = std::sin(0.3);
  SurfaceMesh turned = testing::box(0.5, 0.5, 0.5, 2);
  for (Vec3& p : turned.points) p = {0.4 + c * p.x - s * p.y, 0.2 + s * p.x + c * p.y, p.z + 1};
  const SurfaceMesh ground = testing::box(1, 1, 1, 3);
  // The same on a slope, where nothing is exact.
  for (const double slope : {0.0, 0.7}) {
    const auto tilted = [&](SurfaceMesh m) {
      for (Vec3& p : m.points)
        p = {p.x, std::cos(slope) * p.y - std::sin(slope) * p.z, std::sin(slope) * p.y + std::cos(slope) * p.z};
      return m;
    };
    const Complex complex = join_bodies({{"ground", tilted(ground)}, {"turned", tilted(turned)}});
    ASSERT_EQ(complex.volumes.size(), 2U);
    EXPECT_NEAR(complex.volumes[0], 1, 1e-9);
    EXPECT_NEAR(complex.volumes[1], 0.125, 1e-9);
    EXPECT_NEAR(interface_area(complex.surface), 0.25, 1e-9);
    EXPECT_TRUE(self_intersections(complex.surface.points, complex.surface.triangles).empty());
  }
}

TEST(JoinBodies, TheLaterOneHasItsWay) {
  const SurfaceMesh a = testing::cube(1), b = testing::transformed(testing::cube(1), 1, {.5, 0, 0});
  EXPECT_NEAR(join_bodies({{"a", a}, {"b", b}}).volumes[0], 0.5, 1e-12);
  EXPECT_NEAR(join_bodies({{"b", b}, {"a", a}}).volumes[0], 0.5, 1e-12);
  const Complex inside = join_bodies({{"a", a}, {"in", testing::transformed(testing::cube(1), 0.5, {.25, .25, .25})}});
  EXPECT_NEAR(inside.volumes[0], 0.875, 1e-12);
  EXPECT_NEAR(inside.volumes[1], 0.125, 1e-12);
}

TEST(JoinBodies, WhatBodiesShareGoesWhereItIsAsked) {
  const std::vector<Body> bodies{{"a", testing::cube(1)},
                                 {"b", testing::transformed(testing::cube(1), 1, {.75, 0, 0})}};
  using Overlap = ComplexOptions::Overlap;
  const auto joined = [&](Overlap overlap) {
    ComplexOptions options;
    options.overlap = overlap;
    return join_bodies(bodies, options);
  };
  EXPECT_NEAR(joined(Overlap::kFirst).volumes[1], 0.75, 1e-12);
  EXPECT_NEAR(joined(Overlap::kLater).volumes[0], 0.75, 1e-12);
  const Complex apart = joined(Overlap::kNew);
  EXPECT_EQ(apart.surface.region_names, (std::vector<std::string>{"a", "b", "a&b"}));
  ASSERT_EQ(apart.volumes.size(), 3U);
  EXPECT_NEAR(apart.volumes[0], 0.75, 1e-12);
  EXPECT_NEAR(apart.volumes[1], 0.75, 1e-12);
  EXPECT_NEAR(apart.volumes[2], 0.25, 1e-12);
  EXPECT_NEAR(testing::region_volumes(apart.surface)[2], 0.25, 1e-12);
}

TEST(JoinBodies, OfABodyWithinAnotherNothingIsLeftForThatOneFirst) {
  const std::vector<Body> bodies{{"a", testing::cube(1)},
                                 {"in", testing::transformed(testing::cube(1), 0.5, {.25, .25, .25})}};
  ComplexOptions options;
  options.overlap = ComplexOptions::Overlap::kFirst;
  try {
    join_bodies(bodies, options);
    FAIL() << "it is covered";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("in: nothing of it is left, for earlier bodies"), std::string::npos);
  }
  options.overlap = ComplexOptions::Overlap::kNew;
  EXPECT_EQ(join_bodies(bodies, options).surface.region_names, (std::vector<std::string>{"a", "a&in"}));
}

/// Solids of one file, a patch each.
SurfaceMesh in_one_file(const std::vector<Body>& solids) {
  SurfaceMesh all;
  for (const Body& solid : solids) {
    const auto first = static_cast<VertexIndex>(all.points.size());
    all.points.insert(all.points.end(), solid.surface.points.begin(), solid.surface.points.end());
    for (const auto& [a, b, c] : solid.surface.triangles) {
      all.triangles.push_back({first + a, first + b, first + c});
      all.patch.push_back(static_cast<std::uint32_t>(all.patch_names.size()));
    }
    all.patch_names.push_back(solid.name);
  }
  return all;
}

SurfaceMesh moved_cube(double scale, double x, double yz) {
  return testing::transformed(testing::cube(1), scale, {x, yz, yz});
}

TEST(JoinBodies, OverlapsNameTheBodiesAndTheVolume) {
  const Complex complex = join_bodies({{"a", testing::cube(1)}, {"b", moved_cube(1, .5, 0)}});
  const auto said = [&](const std::string& words) {
    return std::any_of(complex.notes.begin(), complex.notes.end(),
                       [&](const std::string& note) { return note.find(words) != std::string::npos; });
  };
  EXPECT_TRUE(said("\"b\" takes 0.5 from \"a\""));
}

TEST(SolidsOfOneFile, ThatTouchAreRegionsByName) {
  const auto complex = complex_of_walls(in_one_file({{"left", testing::cube(1)}, {"right", moved_cube(0.5, 1, 0.25)}}));
  ASSERT_TRUE(complex);
  EXPECT_EQ(complex->surface.region_names, (std::vector<std::string>{"left", "right"}));
  EXPECT_NEAR(complex->volumes[1], 0.125, 1e-12);
  EXPECT_NEAR(interface_area(complex->surface), 0.25, 1e-12);
}

TEST(SolidsOfOneFile, InsideOthersAreRegionsByNameInAnyOrder) {
  for (const bool inner_first : {false, true}) {
    std::vector<Body> solids{{"A", testing::cube(1)}, {"ball", moved_cube(0.5, 0.25, 0.25)}};
    if (inner_first) std::swap(solids[0], solids[1]);
    const auto complex = complex_of_walls(in_one_file(solids));
    ASSERT_TRUE(complex);
    EXPECT_EQ(complex->surface.region_names, (std::vector<std::string>{"A", "ball"}));
    EXPECT_NEAR(complex->volumes[0], 0.875, 1e-12);
  }
}

TEST(SolidsOfOneFile, StayPlainWhereNothingIsShared) {
  const SurfaceMesh apart = in_one_file({{"a", testing::cube(1)}, {"b", moved_cube(1, 3, 0)}});
  EXPECT_FALSE(complex_of_walls(apart));
  // Who overlaps is united by repair, and so is who asks for that.
  EXPECT_FALSE(complex_of_walls(in_one_file({{"a", testing::cube(1)}, {"b", moved_cube(1, 0.5, 0.25)}})));
  ComplexOptions merge;
  merge.cells = ComplexOptions::Cells::kMerge;
  const auto one = complex_of_walls(in_one_file({{"a", testing::cube(1)}, {"b", moved_cube(1, 1, 0)}}), merge);
  ASSERT_TRUE(one);
  EXPECT_EQ(one->volumes.size(), 1U);
  // A shell that faces inward is a cavity, whatever it is called.
  SurfaceMesh hole = moved_cube(0.5, 0.25, 0.25);
  for (Triangle& t : hole.triangles) std::swap(t[1], t[2]);
  EXPECT_FALSE(complex_of_walls(in_one_file({{"a", testing::cube(1)}, {"hole", hole}})));
  ComplexOptions regions;
  regions.cells = ComplexOptions::Cells::kRegions;
  ASSERT_TRUE(complex_of_walls(apart, regions));
  EXPECT_EQ(complex_of_walls(apart, regions)->surface.region_names, (std::vector<std::string>{"a", "b"}));
}

TEST(JoinBodies, ABodyThatIsCoveredIsRefusedByName) {
  try {
    join_bodies({{"small", testing::transformed(testing::cube(1), 0.5, {.25, .25, .25})}, {"large", testing::cube(1)}});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("small"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("large"), std::string::npos);
  }
}

TEST(JoinBodies, AnOpenBodyIsRefusedByName) {
  SurfaceMesh open = testing::cube(1);
  open.triangles.pop_back();
  open.patch.clear();
  try {
    join_bodies({{"first", testing::cube(1)}, {"second", open}});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).substr(0, 8), "second: ");
  }
}

TEST(JoinBodies, SeedsFillAndEmpty) {
  // A hollow body; what is in it belongs to nobody until a point says so.
  const SurfaceMesh hollow = testing::joined(
      testing::cube(2), testing::reversed(testing::transformed(testing::cube(1), 0.5, {.25, .25, .25})));
  ComplexOptions options;
  options.regions = {{"core", {.5, .5, .5}}};
  const Complex complex = join_bodies({{"shell", hollow}}, options);
  EXPECT_EQ(complex.surface.region_names, (std::vector<std::string>{"shell", "core"}));
  EXPECT_NEAR(complex.volumes[1], 0.125, 1e-12);
}

}  // namespace
}  // namespace octafront
