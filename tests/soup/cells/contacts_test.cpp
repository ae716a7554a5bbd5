// Bodies that touch, and were faceted apart.

#include <octafront/complex.h>
#include <octafront/inside.h>

#include "base/geometry/self_intersection.h"
#include "base/mesh/complex.h"
#include "soup/cells/bodies.h"
#include "support/complexes.h"
#include "support/convex_cells.h"
#include "support/faceted.h"
#include "support/named_surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using testing::faceted_pin, testing::faceted_ring;

Complex joined_at(const std::vector<Body>& bodies, double size, std::optional<double> tolerance = {}) {
  ComplexOptions options;
  options.tolerance = tolerance;
  return cells::join_bodies(bodies, options, {size, {}}, {});
}

/// Two regions, nothing between them, and no face that a mesh could not have.
void expect_in_contact(const Complex& complex, std::vector<double> volumes, double within) {
  ASSERT_EQ(complex.volumes.size(), volumes.size());
  for (std::size_t r = 0; r < volumes.size(); ++r) {
    EXPECT_NEAR(complex.volumes[r], volumes[r], within);
    EXPECT_NEAR(testing::region_volumes(complex.surface)[r], volumes[r], within);
  }
  EXPECT_TRUE(self_intersections(complex.surface.points, complex.surface.triangles).empty());
}

bool is_said(const Complex& complex, const std::string& words) {
  return std::any_of(complex.notes.begin(), complex.notes.end(),
                     [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

double shortest_edge(const SurfaceMesh& surface) {
  double least = HUGE_VAL;
  for (const auto& [a, b, c] : surface.triangles)
    for (const auto& [p, q] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}})
      least = std::min(least, distance(surface.points[p], surface.points[q]));
  return least;
}

double polygon(int sides, double radius) {
  return sides / 2.0 * radius * radius * std::sin(2 * std::acos(-1) / sides);
}

TEST(Contacts, TheWallOfTheEarlierBodyIsLeftWhateverTheSides) {
  struct Sides {
    int ring, pin;
  };
  for (const auto& [n, m] : {Sides{6, 8}, Sides{12, 16}, Sides{24, 25}, Sides{48, 49}, Sides{20, 20}, Sides{16, 48}}) {
    SCOPED_TRACE(::testing::Message() << n << " against " << m);
    const SurfaceMesh ring = faceted_ring(n, 5, 10, 4), pin = faceted_pin(m, 5, 0, 4, n == m ? .1 : 0);
    const double round = 4 * polygon(n, 10);
    const Complex pin_later = joined_at({{"ring", ring}, {"pin", pin}}, 1);
    expect_in_contact(pin_later, {round - 4 * polygon(n, 5), 4 * polygon(n, 5)}, 1e-9);
    EXPECT_TRUE(is_said(pin_later, "walls of bodies that nearly touch are one"));
    const Complex ring_later = joined_at({{"pin", pin}, {"ring", ring}}, 1);
    expect_in_contact(ring_later, {4 * polygon(m, 5), round - 4 * polygon(m, 5)}, 1e-9);
  }
}

TEST(Contacts, ABoltThatStandsOut) {
  const SurfaceMesh plate = faceted_ring(48, 5, 12, 6), bolt = faceted_pin(36, 5, -4, 10);
  const Complex complex = joined_at({{"plate", plate}, {"bolt", bolt}}, 1.5);
  const double hole = 6 * polygon(48, 5);
  // It is as thick as the hole in it, and between both beside it.
  ASSERT_EQ(complex.volumes.size(), 2U);
  EXPECT_NEAR(complex.volumes[0], 6 * polygon(48, 12) - hole, 1e-9);
  EXPECT_GT(complex.volumes[1], hole + 8 * polygon(36, 5) - 1e-9);
  EXPECT_LT(complex.volumes[1], hole + 8 * polygon(48, 5));
  EXPECT_TRUE(self_intersections(complex.surface.points, complex.surface.triangles).empty());
}

TEST(Contacts, CoarseWallsWithoutAVertexInTheContact) {
  // The bolt's ends are far from the ring: only its edges know how far the walls are apart.
  const SurfaceMesh ring = faceted_ring(8, 1, 2.2, 1), bolt = faceted_pin(13, 1, -.7, 1.9, .2);
  const double round = polygon(8, 2.2), wide = polygon(8, 1), narrow = polygon(13, 1);
  const Complex ring_later = joined_at({{"bolt", bolt}, {"ring", ring}}, .4);
  expect_in_contact(ring_later, {2.6 * narrow, round - narrow}, .1);
  const Complex bolt_later = joined_at({{"ring", ring}, {"bolt", bolt}}, .4);
  expect_in_contact(bolt_later, {round - wide, wide + 1.6 * narrow}, .4);
  for (const Complex* complex : {&ring_later, &bolt_later}) {
    EXPECT_GT(shortest_edge(complex->surface), .1);
    EXPECT_FALSE(is_said(*complex, "faces divided"));
  }
}

TEST(Contacts, FineWallsComeToCoarseOnesInAnyOrder) {
  // Six sides cut off 13 % of the radius: bent to finer walls they would cross each other.
  const SurfaceMesh ring = faceted_ring(6, 1, 2.2, 1);
  const double round = polygon(6, 2.2), hole = polygon(6, 1);
  for (const int sides : {13, 24, 48}) {
    SCOPED_TRACE(sides);
    const SurfaceMesh bolt = faceted_pin(sides, 1, -.7, 1.9, .1);
    const Complex bolt_first = joined_at({{"bolt", bolt}, {"ring", ring}}, .4);
    const Complex ring_first = joined_at({{"ring", ring}, {"bolt", bolt}}, .4);
    for (const Complex* complex : {&bolt_first, &ring_first}) {
      const bool is_bolt_first = complex == &bolt_first;
      ASSERT_EQ(complex->volumes.size(), 2U);
      // The bolt is as thick as one of both in the hole, and between both beside it.
      EXPECT_GT(complex->volumes[!is_bolt_first], 2.6 * hole - 1e-9);
      EXPECT_LT(complex->volumes[!is_bolt_first], 2.6 * polygon(sides, 1) + 1e-9);
      EXPECT_GT(complex->volumes[is_bolt_first], round - polygon(sides, 1) - .1);
      EXPECT_LT(complex->volumes[is_bolt_first], round - hole + 1e-9);
      EXPECT_GT(shortest_edge(complex->surface), .5 * 2 * std::sin(std::acos(-1) / sides));
      EXPECT_TRUE(self_intersections(complex->surface.points, complex->surface.triangles).empty());
    }
    EXPECT_EQ(is_said(bolt_first, "those of the coarser body"), sides == 13);
    EXPECT_FALSE(is_said(bolt_first, "could not be made one everywhere"));
  }
}

TEST(Contacts, WhatCouldNotBeMadeOneIsSaid) {
  // Five sides stand for no curve, and cut deep into the bolt.
  const SurfaceMesh ring = faceted_ring(5, 1, 2.2, 1);
  const double given = 2 * std::sin(std::acos(-1) / 48);
  int split = 0;
  for (const double turn : {.03, .1}) {
    SCOPED_TRACE(turn);
    const Complex complex = joined_at({{"ring", ring}, {"bolt", faceted_pin(48, 1, -.7, 1, turn)}}, .35);
    const bool is_split = shortest_edge(complex.surface) < .5 * given;
    EXPECT_TRUE(!is_split || is_said(complex, "could not be made one everywhere: "));
    split += is_split;
    EXPECT_EQ(complex.volumes.size(), 2U);
  }
  EXPECT_GT(split, 0) << "mended: choose others";
}

/// Volumes within the misfit, no short edges, and nothing said of walls that could not be made one.
void expect_one_wall(const std::vector<Body>& bodies, double misfit, double size) {
  std::vector<std::size_t> order(bodies.size());
  std::iota(order.begin(), order.end(), 0);
  do {
    std::vector<Body> ordered;
    for (const std::size_t b : order) ordered.push_back(bodies[b]);
    const Complex complex = joined_at(ordered, size);
    ASSERT_EQ(complex.volumes.size(), bodies.size());
    for (std::size_t b = 0; b < bodies.size(); ++b)
      EXPECT_NEAR(complex.volumes[b], enclosed_volume(ordered[b].surface), misfit * area(ordered[b].surface));
    EXPECT_FALSE(is_said(complex, "could not be made one everywhere"));
    EXPECT_TRUE(self_intersections(complex.surface.points, complex.surface.triangles).empty());
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(Contacts, AWasherIsNotDrawnThroughItself) {
  // Its far rim is nearer to the plate's hole than the misfit of their sides allows.
  for (const int sides : {7, 12, 60}) {
    SCOPED_TRACE(sides);
    const SurfaceMesh washer = faceted_ring(sides, 1, 2, .25);
    expect_one_wall({{"plate", faceted_ring(6, 1, 3.5, 1)}, {"washer", testing::transformed(washer, 1, {0, 0, -.25})}},
                    .15, .35);
  }
}

TEST(Contacts, APlugWithAConeIsNoCurve) {
  // Between cylinder and cone there is one edge of 45 degrees, which stands for no arc.
  for (const auto& [n, m] : {std::pair{24, 14}, {12, 20}, {16, 36}}) {
    SCOPED_TRACE(n);
    expect_one_wall({{"hole", testing::faceted_countersink(n)}, {"plug", testing::faceted_plug(m, .3)}}, .08, .35);
  }
}

TEST(Contacts, KeptTrianglesAreNotFlat) {
  // Where walls that turn cross edges of others, a little beside their corners.
  for (const auto& [n, m] : {std::pair{24, 25}, {16, 17}, {20, 20}}) {
    SCOPED_TRACE(n);
    const Complex complex =
        joined_at({{"bolt", faceted_pin(m, 1, -.7, 1.9, .1)}, {"ring", faceted_ring(n, 1, 2.2, 1)}}, .3);
    double flattest = 1;
    for (const auto& [a, b, c] : complex.surface.triangles) {
      const auto& p = complex.surface.points;
      const double longest = std::max({distance(p[a], p[b]), distance(p[b], p[c]), distance(p[c], p[a])});
      flattest = std::min(flattest, length(cross(p[b] - p[a], p[c] - p[a])) / (longest * longest));
    }
    EXPECT_GT(flattest, .005);
  }
}

TEST(Contacts, WallsThatWeaveThroughEachOther) {
  // Threads, whose facets are twisted: none of the later body's lies on one of the earlier's.
  struct Facets {
    int nut_sides, nut_steps, screw_sides, screw_steps;
  };
  for (const auto& [n, k, m, l] : {Facets{16, 12, 25, 21}, Facets{24, 18, 18, 14}, Facets{32, 12, 36, 21}}) {
    SCOPED_TRACE(::testing::Message() << n << " against " << m);
    const SurfaceMesh nut = testing::faceted_nut(n, k), screw = testing::faceted_screw(m, l, .1);
    const double whole = 1.2 * polygon(n, 2), nut_alone = enclosed_volume(nut), screw_alone = enclosed_volume(screw);
    const Complex screw_later = joined_at({{"nut", nut}, {"screw", screw}}, .4);
    expect_in_contact(screw_later, {nut_alone, whole - nut_alone}, 1e-9);
    EXPECT_GT(shortest_edge(screw_later.surface), .9 * std::min(1.2 / k, 2 * std::sin(std::acos(-1) / n)));
    const Complex nut_later = joined_at({{"screw", screw}, {"nut", nut}}, .4);
    expect_in_contact(nut_later, {screw_alone, whole - screw_alone}, 1e-9);
  }
}

TEST(Contacts, PartOfAWall) {
  const SurfaceMesh inner = faceted_pin(24, 5, 0, 4), plaque = testing::faceted_segment(13, 5, 7, 1, 3, .3, 1.3);
  const Complex complex = joined_at({{"inner", inner}, {"plaque", plaque}}, 1);
  EXPECT_NEAR(complex.volumes[0], 4 * polygon(24, 5), 1e-9);
  EXPECT_NEAR(complex.volumes[1], testing::region_volumes(complex.surface)[1], 1e-9);
  // The area of the contact, times how far the walls are apart.
  EXPECT_NEAR(complex.volumes[1], enclosed_volume(plaque), 10 * 5 * (1 - std::cos(std::acos(-1) / 24)));
  EXPECT_GT(shortest_edge(complex.surface), .1);
  EXPECT_TRUE(self_intersections(complex.surface.points, complex.surface.triangles).empty());
}

TEST(Contacts, ToleranceIsMonotone) {
  // A ball in its cavity; whatever more is allowed, what is measured counts.
  const SurfaceMesh block = testing::joined(testing::transformed(testing::cube(1), 12, {-6, -6, -6}),
                                            testing::reversed(testing::icosphere(2, 3)));
  const SurfaceMesh ball = testing::faceted_ball(16, 8, 3);
  const double cavity = enclosed_volume(testing::icosphere(2, 3)), whole = 12 * 12 * 12;
  for (const std::optional<double> tolerance : {std::optional<double>(), {.1}, {.2}, {.3}, {.5}, {3.}}) {
    SCOPED_TRACE(tolerance.value_or(-1));
    expect_in_contact(joined_at({{"block", block}, {"ball", ball}}, 1.5, tolerance), {whole - cavity, cavity}, 1e-9);
    const double own = enclosed_volume(ball);
    expect_in_contact(joined_at({{"ball", ball}, {"block", block}}, 1.5, tolerance), {own, whole - own}, 1e-9);
  }
}

TEST(Contacts, BoxesThatOverlapOrGapAreFlush) {
  const SurfaceMesh a = testing::cube(1);
  for (const double off : {1e-7, 1e-6, 1e-5, 2e-5, 1e-4, 1e-3, 1e-2, -1e-6, -1e-4, -1e-2}) {
    SCOPED_TRACE(off);
    for (const double scale : {1e-3, 1.0, 1e6}) {
      const SurfaceMesh b = testing::transformed(testing::cube(1), scale, {scale * (1 - off), 0, 0});
      const Complex complex = joined_at({{"a", testing::transformed(a, scale, {0, 0, 0})}, {"b", b}}, .2 * scale);
      const double v = scale * scale * scale;
      expect_in_contact(complex, {v, v * (1 - off)}, 1e-6 * v);
      // Eight corners each, four of them the same, and one in the middle of each face of a cube of this support.
      EXPECT_LE(complex.surface.points.size(), 2 * a.points.size() - 4);
    }
  }
}

TEST(Contacts, OneFileWithoutNames) {
  // The wall between is warped, and cut along the other diagonal.
  for (const double warp : {1e-12, 1e-9, 1e-6, 1e-4}) {
    SCOPED_TRACE(warp);
    SurfaceMesh two;
    for (const double x : {0., 1.})
      for (const double z : {0., 1.})
        for (const double y : {0., 1.})
          for (const double dx : {0., 1.}) two.points.push_back({x + dx, y, z});
    two.points[8].x += warp;
    for (const VertexIndex f : {0u, 8u}) {
      const auto quad = [&](VertexIndex a, VertexIndex b, VertexIndex c, VertexIndex d) {
        two.triangles.push_back({f + a, f + b, f + c});
        two.triangles.push_back({f + a, f + c, f + d});
      };
      quad(0, 2, 3, 1);
      quad(4, 5, 7, 6);
      quad(0, 1, 5, 4);
      quad(2, 6, 7, 3);
      if (f == 0) quad(1, 3, 7, 5);
      if (f == 0) quad(0, 4, 6, 2);
      if (f == 8) quad(4, 6, 2, 0);
      if (f == 8) quad(1, 3, 7, 5);
    }
    const std::optional<Complex> complex = cells::complex_of_walls(two, {}, {.2, {}}, {});
    ASSERT_TRUE(complex);
    expect_in_contact(*complex, {1, 1}, 1e-4);
  }
}

TEST(Contacts, SolidsOfOneFileByName) {
  SurfaceMesh both = testing::joined(faceted_ring(24, 5, 10, 4), faceted_pin(25, 5, 0, 4));
  both.patch_names = {"ring", "pin"};
  both.patch.assign(both.triangles.size(), 1);
  std::fill(both.patch.begin(), both.patch.begin() + 24 * 8, 0);
  const std::optional<Complex> complex = cells::complex_of_walls(both, {}, {1, {}}, {});
  ASSERT_TRUE(complex);
  EXPECT_EQ(complex->surface.region_names, (std::vector<std::string>{"ring", "pin"}));
  expect_in_contact(*complex, {4 * (polygon(24, 10) - polygon(24, 5)), 4 * polygon(24, 5)}, 1e-9);
}

TEST(Contacts, ThreeBodiesAtOneEdge) {
  // A ring of three parts around a pin, all faceted apart, a little off.
  const double third = 2 * std::acos(-1) / 3;
  std::vector<Body> bodies{{"pin", faceted_pin(17, 2, 0, 2)}};
  for (int i = 0; i < 3; ++i)
    bodies.push_back({"part" + std::to_string(i),
                      testing::faceted_segment(5 + i, 2, 4, 1e-5 * i, 2 - 1e-4 * i, i * third, (i + 1) * third)});
  const Complex complex = joined_at(bodies, .5);
  ASSERT_EQ(complex.volumes.size(), 4U);
  EXPECT_GT(shortest_edge(complex.surface), .1);
  EXPECT_TRUE(self_intersections(complex.surface.points, complex.surface.triangles).empty());
  double all = 0;
  for (const double v : complex.volumes) all += v;
  EXPECT_NEAR(all, 2 * polygon(18, 4), 2.5);
}

TEST(Contacts, NothingIsMovedWithoutTolerance) {
  const SurfaceMesh a = testing::cube(1), b = testing::transformed(testing::cube(1), 1, {.999, 0, 0});
  const Complex complex = joined_at({{"a", a}, {"b", b}}, .2, 0.0);
  EXPECT_NEAR(complex.volumes[0], .999, 1e-12);
  EXPECT_NEAR(complex.volumes[1], 1, 1e-12);
}

TEST(Contacts, WallsFartherApartStay) {
  // Apart by half of the size, and plates nearer than that but no thicker than what is between them.
  const auto plates = [](double thickness, double gap) {
    return std::vector<Body>{{"low", testing::box(1, 1, thickness)},
                             {"high", testing::transformed(testing::box(1, 1, thickness), 1, {0, 0, thickness + gap})}};
  };
  EXPECT_NEAR(joined_at(plates(1, .1), .2).volumes[1], 1, 1e-12);
  EXPECT_NEAR(joined_at(plates(.02, .01), .2).volumes[1], .02, 1e-12);
  EXPECT_NEAR(joined_at(plates(1, .01), .2).volumes[1], 1.01, 1e-12);
}

TEST(Contacts, AnEdgeInTheMiddleOfAFace) {
  // Boxes that stand side by side on another one: the edge between them ends amid its face.
  const SurfaceMesh low = testing::box(2, 1, 1), high = testing::cube(1);
  for (const double gap : {0.0, 1e-6, -1e-6, 1e-3}) {
    SCOPED_TRACE(gap);
    const auto at = [&](double x) { return testing::transformed(high, 1, {x, 0, 1 + gap}); };
    const Complex complex = joined_at({{"low", low}, {"left", at(-.3)}, {"right", at(.7 + gap)}}, .2);
    expect_in_contact(complex, {2, 1, 1}, 3e-3);
    EXPECT_GT(shortest_edge(complex.surface), .05);
  }
}

/// Each cell written by itself, with so few digits that its faces are no planes any more and divided in other ways.
std::vector<Body> rounded_cells(int sites, unsigned seed, std::vector<double>& volumes) {
  testing::ConvexCells foam({1, 1, 1});
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(0.02, 0.98);
  for (int k = 0; k < sites; ++k) foam.insert_site({u(random), u(random), u(random)});
  const SurfaceMesh complex = foam.complex();
  std::vector<Body> cells;
  for (std::uint32_t c = 0; c < foam.count(); ++c) {
    SurfaceMesh cell = boundary_of_region(complex, c);
    cell.patch.clear(), cell.patch_names.clear();
    volumes.push_back(enclosed_volume(cell));
    for (Vec3& p : cell.points)
      for (int axis = 0; axis < 3; ++axis) p[axis] = std::round(1e6 * p[axis] + 0.3 * (c % 3)) / 1e6;
    cells.push_back({"cell " + std::to_string(c), cell});
  }
  return cells;
}

TEST(Contacts, CellsOfAFoamAreThoseThatThereAre) {
  std::vector<double> volumes;
  const std::vector<Body> cells = rounded_cells(12, 3, volumes);
  expect_in_contact(joined_at(cells, .2), volumes, 1e-5);
}

/// Vertices of different cells that are the same are one there.
TEST(Contacts, CellsOfAFoamInOneFileWithoutNames) {
  std::vector<double> volumes;
  SurfaceMesh all;
  std::map<std::array<double, 3>, VertexIndex> number;
  for (const Body& cell : rounded_cells(12, 3, volumes))
    for (const Triangle& t : cell.surface.triangles) {
      Triangle made{};
      for (int i = 0; i < 3; ++i) {
        const Vec3 p = cell.surface.points[t[i]];
        const auto [at, is_new] = number.try_emplace({p.x, p.y, p.z}, static_cast<VertexIndex>(number.size()));
        if (is_new) all.points.push_back(p);
        made[i] = at->second;
      }
      all.triangles.push_back(made);
    }
  ASSERT_LT(all.points.size(), 3 * volumes.size() * 8);
  for (const auto cells : {ComplexOptions::Cells::kRegions, ComplexOptions{}.cells}) {
    ComplexOptions options;
    options.cells = cells;
    const std::optional<Complex> complex = cells::complex_of_walls(all, options, {.2, {}}, {});
    ASSERT_TRUE(complex);
    // The larger ones come first.
    std::sort(volumes.rbegin(), volumes.rend());
    expect_in_contact(*complex, volumes, 1e-5);
  }
}

TEST(Contacts, ASheetThatEndsJustBeforeAWall) {
  SurfaceMesh sheet;
  constexpr double kShort = 1e-4;
  sheet.points = {
      {kShort, kShort, .5}, {1 - kShort, kShort, .5}, {1 - kShort, 1 - kShort, .5}, {kShort, 1 - kShort, .5}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  const Complex complex = cells::embed_sheets(testing::cube(1), {{"mid", sheet}}, {}, {.2, {}}, {});
  double area = 0;
  for (std::size_t t = 0; t < complex.surface.triangles.size(); ++t) {
    if (complex.surface.sides[t][0] != complex.surface.sides[t][1]) continue;
    const auto [a, b, c] = complex.surface.triangles[t];
    const auto& p = complex.surface.points;
    area += length(cross(p[b] - p[a], p[c] - p[a])) / 2;
  }
  EXPECT_NEAR(area, 1, 1e-9);
}

}  // namespace
}  // namespace octafront
