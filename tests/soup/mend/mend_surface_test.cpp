#include <octafront/error.h>
#include <octafront/mend.h>
#include <octafront/repair.h>

#include "base/core/thread_limit.h"
#include "base/geometry/hausdorff.h"
#include "support/named_surfaces.h"
#include "support/random.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using Kind = MendChange::Kind;

void expect_clean(const SurfaceMesh& surface) {
  const SurfaceDefects defects = find_defects(repair_surface(surface));
  EXPECT_TRUE(defects.clean()) << defects.describe();
}

Mended mended(const SurfaceMesh& soup, const MendOptions& options = {}) {
  Mended result = mend_surface(soup, options);
  expect_clean(result.surface);
  return result;
}

MendOptions within(double tolerance) {
  MendOptions options;
  options.tolerance = tolerance;
  return options;
}

MendOptions wrap_at(double distance) {
  MendOptions options;
  options.way = MendOptions::Way::kWrap;
  options.distance = distance;
  return options;
}

SurfaceMesh box_at(Vec3 corner, Vec3 size, int n = 1) {
  return testing::transformed(testing::box(size.x, size.y, size.z, n), 1, corner);
}

SurfaceMesh without(SurfaceMesh surface, const std::function<bool(Vec3)>& gone) {
  surface.patch.clear();
  std::erase_if(surface.triangles, [&](const Triangle& t) {
    return gone((surface.points[t[0]] + surface.points[t[1]] + surface.points[t[2]]) / 3);
  });
  return surface;
}

TEST(MendSurface, WhatIsCleanComesBackBitForBit) {
  for (const SurfaceMesh& clean : {testing::cube(2), testing::torus(20, 10), testing::hollow_sphere(2)}) {
    const Mended result = mend_surface(clean);
    EXPECT_TRUE(result.report.clean);
    EXPECT_EQ(result.surface, clean);
    EXPECT_TRUE(result.report.changes.empty());
  }
}

TEST(MendSurface, BoundsHoldWhereSomethingMovedOnly) {
  const SurfaceMesh ball = testing::icosphere(3);
  EXPECT_TRUE(mended(without(ball, [](Vec3 p) { return p.z > 0.95; })).bound.empty());  // nothing moved
  EXPECT_TRUE(mended(testing::joined(ball, testing::transformed(ball, 1, {0.5, 0.1, 0}))).bound.empty());
  MendOptions coarse;
  coarse.tolerance = 0.05;  // what closes the hole lies within it
  EXPECT_TRUE(mend_surface(without(ball, [](Vec3 p) { return p.z > 0.95; }), coarse).bound.empty());

  SurfaceMesh torn = ball;  // one triangle with corners of its own
  const Vec3 place = torn.points[torn.triangles[0][0]];
  for (VertexIndex& v : torn.triangles[0]) {
    torn.points.push_back(torn.points[v] + Vec3{3e-4, 2e-4, -1e-4});
    v = static_cast<VertexIndex>(torn.points.size() - 1);
  }
  const Mended result = mended(torn);
  ASSERT_EQ(result.bound.size(), result.surface.triangles.size());
  std::size_t tight = 0;
  for (std::size_t t = 0; t < result.bound.size(); ++t) {
    if (std::isinf(result.bound[t])) continue;
    ++tight;
    EXPECT_EQ(result.bound[t], result.report.tolerance);
    EXPECT_LT(distance(result.surface.points[result.surface.triangles[t][0]], place), 0.6);
  }
  EXPECT_GE(tight, 4u);
  EXPECT_LT(tight, 30u);
}

TEST(MendSurface, OverlappingPartsUnite) {
  const Mended result = mended(testing::joined(box_at({0, 0, 0}, {2, 2, 2}), box_at({1, 1, 1}, {2, 2, 2})));
  EXPECT_NEAR(enclosed_volume(result.surface), 15, 1e-12);
  EXPECT_EQ(result.report.bodies, 1u);
  EXPECT_GT(result.report.crossing_pairs, 0u);
  EXPECT_GT(result.report.count(Kind::kCut), 0u);
  EXPECT_EQ(result.report.largest_move, 0);
}

TEST(MendSurface, InnerWallsAndDebrisVanish) {
  SurfaceMesh soup = testing::joined(box_at({0, 0, 0}, {2, 2, 2}), box_at({0.5, 0.5, 0.5}, {0.1, 0.2, 0.3}));
  soup.patch.clear();
  // A wall that pierces the skin, so that this is no clean complex.
  const auto first = static_cast<VertexIndex>(soup.points.size());
  for (const Vec3 p : {Vec3{1, -1, -1}, Vec3{1, 3, -1}, Vec3{1, 3, 3}, Vec3{1, -1, 3}}) soup.points.push_back(p);
  soup.triangles.push_back({first, first + 1, first + 2});
  soup.triangles.push_back({first, first + 2, first + 3});
  const Mended result = mended(soup);
  EXPECT_NEAR(enclosed_volume(result.surface), 8, 1e-12);
  EXPECT_EQ(result.report.bodies, 1u);
  EXPECT_GE(result.report.count(Kind::kDropped), 1u);
}

TEST(MendSurface, DoubledWallsBecomeOne) {
  // Two boxes side by side, each with its own wall between, divided otherwise, and one of them a second time.
  const SurfaceMesh pair = testing::joined(box_at({0, 0, 0}, {1, 1, 1}), box_at({1, 0, 0}, {1, 1, 1}, 2));
  const Mended result = mended(testing::joined(pair, box_at({0, 0, 0}, {1, 1, 1}, 3)));
  EXPECT_NEAR(enclosed_volume(result.surface), 2, 1e-12);
  EXPECT_EQ(result.report.bodies, 1u);
}

TEST(MendSurface, PartsThatFaceInwardTurn) {
  const SurfaceMesh crossing =
      testing::joined(testing::reversed(box_at({0, 0, 0}, {2, 2, 2})), box_at({1, 1, 1}, {2, 2, 2}));
  EXPECT_NEAR(enclosed_volume(mended(crossing).surface), 15, 1e-12);
}

TEST(MendSurface, CavitiesStay) {
  // Open outside, so that it is not clean; a hollow inside.
  const SurfaceMesh open = without(box_at({0, 0, 0}, {2, 2, 2}), [](Vec3 p) { return p.z == 2; });
  const SurfaceMesh soup = testing::joined(open, testing::reversed(box_at({0.5, 0.5, 0.5}, {1, 1, 1})));
  EXPECT_NEAR(enclosed_volume(mended(soup).surface), 7, 1e-12);
}

TEST(MendSurface, HolesCloseAndAreNamed) {
  SurfaceMesh open = without(box_at({0, 0, 0}, {1, 2, 3}, 3), [](Vec3 p) { return p.z == 3; });
  open.patch.assign(open.triangles.size(), 0);
  open.patch_names = {"wall"};
  const Mended result = mended(open);
  EXPECT_NEAR(enclosed_volume(result.surface), 6, 1e-12);
  ASSERT_EQ(result.report.count(Kind::kClosed), 1u);
  const auto hole = std::find_if(result.report.changes.begin(), result.report.changes.end(),
                                 [](const MendChange& c) { return c.kind == Kind::kClosed; });
  EXPECT_NEAR(hole->size, 2, 1e-12);
  EXPECT_FALSE(hole->within_tolerance);
  ASSERT_EQ(result.surface.patch_names, (std::vector<std::string>{"wall", kClosedByRepair}));
  double closed = 0;
  for (std::size_t t = 0; t < result.surface.triangles.size(); ++t) {
    const auto [a, b, c] = result.surface.triangles[t];
    const auto& p = result.surface.points;
    if (result.surface.patch[t] == 1) closed += length(cross(p[b] - p[a], p[c] - p[a])) / 2;
  }
  EXPECT_NEAR(closed, 2, 1e-12);
}

/// A hill that runs out flat; its rim is torn.
SurfaceMesh hill() {
  SurfaceMesh made;
  constexpr VertexIndex n = 24;
  testing::Random random(3);
  for (VertexIndex y = 0; y <= n; ++y)
    for (VertexIndex x = 0; x <= n; ++x) {
      const bool at_rim = x % n == 0 || y % n == 0;
      const auto stray = [&] { return at_rim ? 0.1 * random.unit() : 0; };
      const double px = x / 3.0 - 4 + stray(), py = y / 3.0 - 4 + stray();
      made.points.push_back({px, py, 9 * std::exp(-(px * px + py * py) / 3) + 0.05 * std::sin(5 * px) + stray()});
    }
  for (VertexIndex y = 0; y < n; ++y)
    for (VertexIndex x = 0; x < n; ++x) {
      const VertexIndex a = y * (n + 1) + x, b = a + 1, c = a + n + 1, d = c + 1;
      made.triangles.push_back({a, b, d});
      made.triangles.push_back({a, d, c});
    }
  return made;
}

/// Degrees: the least angle between two triangles of the surface, inside or outside.
double sharpest(const SurfaceMesh& surface) {
  const auto normal = [&](std::uint32_t t) {
    const auto& [a, b, c] = surface.triangles[t];
    return normalized(cross(surface.points[b] - surface.points[a], surface.points[c] - surface.points[a]));
  };
  std::map<std::pair<VertexIndex, VertexIndex>, std::uint32_t> first;
  double least = 180;
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto edge = std::minmax(surface.triangles[t][k], surface.triangles[t][(k + 1) % 3]);
      const auto [at, is_new] = first.try_emplace(std::pair(edge), t);
      if (is_new) continue;
      const double between = std::clamp(dot(normal(t), normal(at->second)), -1.0, 1.0);
      least = std::min(least, 180 - std::acos(between) * 180 / std::numbers::pi);
    }
  return least;
}

TEST(MendSurface, WhereALidWouldGrazeTheSurfaceABaseClosesIt) {
  const SurfaceMesh up = hill();
  const double volume = enclosed_volume(mended(up).surface);
  SurfaceMesh down = up;
  for (Triangle& t : down.triangles) std::swap(t[1], t[2]);
  for (const SurfaceMesh& soup : {up, down}) {
    const Mended result = mended(soup);
    EXPECT_EQ(result.report.based_holes, 1u);
    EXPECT_EQ(result.report.count(Kind::kDropped), 0u);
    EXPECT_GT(sharpest(result.surface), 30);
    EXPECT_NEAR(enclosed_volume(result.surface), volume, 1e-9 * volume);
    EXPECT_EQ(result.report.bodies, 1u);
  }
  EXPECT_EQ(mended(without(box_at({0, 0, 0}, {1, 2, 3}, 3), [](Vec3 p) { return p.z == 3; })).report.based_holes, 0u);
}

/// A block with a blind hole from below, cut off there; the cut strays from its plane by up to a fifth of the
/// tolerance.
SurfaceMesh cut_block() {
  const auto is_cut = [](Vec3 p) { return p.z == 0; };
  SurfaceMesh hole = without(box_at({1, 1, 0}, {1, 1, 1}, 4), is_cut);
  for (Triangle& t : hole.triangles) std::swap(t[1], t[2]);
  SurfaceMesh block = testing::joined(without(box_at({0, 0, 0}, {3, 3, 3}, 6), is_cut), hole);
  block.patch.clear();
  testing::Random random(5);
  for (Vec3& p : block.points)
    if (p.z == 0) p.z = random.between(-1e-3, 1e-3);
  return block;
}

TEST(MendSurface, ALidWithAHoleInItHasNoMembranes) {
  SurfaceMesh block = cut_block();
  for (int i = 0; i < 2; ++i) {
    const Mended result = mended(block);
    EXPECT_NEAR(enclosed_volume(result.surface), 26, 0.01);
    EXPECT_GT(sharpest(result.surface), 70);  // that of the slanted block: 73.3
    EXPECT_EQ(result.report.crossing_pairs, 0u);
    EXPECT_EQ(result.report.bodies, 1u);
    for (Vec3& p : block.points) p = {p.y, p.z + 0.3 * p.x, p.x};  // another plane
  }
}

TEST(MendSurface, TrianglesAwayFromDefectsStay) {
  const SurfaceMesh soup = testing::joined(box_at({0, 0, 0}, {2, 2, 2}, 6), box_at({1.7, 1.7, 1.7}, {2, 2, 2}, 6));
  const Mended result = mended(soup);
  const auto corners = [](const SurfaceMesh& s, std::size_t t) {
    return std::array{s.points[s.triangles[t][0]], s.points[s.triangles[t][1]], s.points[s.triangles[t][2]]};
  };
  std::size_t same = 0;
  for (std::size_t t = 0; t < result.surface.triangles.size(); ++t)
    same += corners(result.surface, t) == corners(soup, result.surface.source[t]);
  EXPECT_GT(same, soup.triangles.size() * 3 / 4);
}

TEST(MendSurface, WhatTouchesComesApart) {
  // In an edge, and in a point.
  for (const Vec3 at : {Vec3{1, 1, 0}, Vec3{1, 1, 1}}) {
    const Mended result = mended(testing::joined(box_at({0, 0, 0}, {1, 1, 1}), box_at(at, {1, 1, 1})));
    EXPECT_EQ(result.report.bodies, 2u);
    EXPECT_GT(result.report.separated_vertices, 0u);
    EXPECT_NEAR(enclosed_volume(result.surface), 2, 0.01);
    EXPECT_LE(result.report.largest_move, result.report.tolerance);
  }
}

TEST(MendSurface, ThinGapsFill) {
  // A slit of half the tolerance inside of a box, which another one crosses.
  const SurfaceMesh slit = testing::reversed(box_at({0.2, 0.2, 0.5}, {0.5, 0.5, 0.001}));
  const SurfaceMesh boxes = testing::joined(box_at({0, 0, 0}, {1, 1, 1}), box_at({0.9, 0.9, 0.9}, {1, 1, 1}));
  const Mended filled = mended(testing::joined(boxes, slit), within(0.002));
  EXPECT_EQ(filled.report.count(Kind::kFilled) + filled.report.count(Kind::kDropped), 1u);
  EXPECT_NEAR(enclosed_volume(filled.surface), 1.999, 1e-12);
  const Mended kept = mended(testing::joined(boxes, slit), within(0.0005));
  EXPECT_EQ(kept.report.count(Kind::kFilled) + kept.report.count(Kind::kDropped), 0u);
  EXPECT_NEAR(enclosed_volume(kept.surface), 1.999 - 0.00025, 1e-12);
}

TEST(MendSurface, FinsAreDroppedAndSaid) {
  SurfaceMesh soup = box_at({}, {1, 1, 1});
  soup.patch.clear();
  const Triangle on_it = soup.triangles[0];
  soup.points.push_back({3, 3, 3});
  soup.triangles.push_back({on_it[0], on_it[1], static_cast<VertexIndex>(soup.points.size() - 1)});
  const Mended result = mended(soup);
  EXPECT_EQ(result.surface.triangles.size(), soup.triangles.size() - 1);
  EXPECT_EQ(result.report.count(Kind::kDropped), 1u);
}

TEST(MendSurface, FinsThatCrossLeaveNothingBehind) {
  const SurfaceMesh clean = box_at({}, {1, 1, 1}, 4);
  SurfaceMesh soup = clean;
  soup.patch.clear();
  const auto first = static_cast<VertexIndex>(soup.points.size());
  soup.points.insert(soup.points.end(), {{0.31, 0.33, 0.5}, {0.47, 0.62, 1.3}, {0.9, 0.57, 1.2}});
  soup.triangles.push_back({first, first + 1, first + 2});
  const Mended result = mended(soup);
  EXPECT_EQ(result.surface.triangles.size(), clean.triangles.size());
  EXPECT_EQ(result.surface.points.size(), clean.points.size());
  EXPECT_NEAR(enclosed_volume(result.surface), 1, 1e-14);
  EXPECT_EQ(result.report.count(Kind::kDropped), 1u);
}

/// The section of a convex body around the origin by the plane normal . x = height, as a fan of its own points.
SurfaceMesh with_a_wall(SurfaceMesh surface, const SurfaceMesh& body, Vec3 normal, double height) {
  const Vec3 middle = normal * (height / dot(normal, normal));
  for (const Triangle& t : body.triangles) {
    std::vector<Vec3> ends{middle};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 p = body.points[t[k]], q = body.points[t[(k + 1) % 3]];
      const double a = dot(normal, p) - height, b = dot(normal, q) - height;
      if ((a > 0) != (b > 0)) ends.push_back(p + (q - p) * (a / (a - b)));
    }
    if (ends.size() != 3) continue;
    const auto first = static_cast<VertexIndex>(surface.points.size());
    surface.points.insert(surface.points.end(), ends.begin(), ends.end());
    surface.triangles.push_back({first, first + 1, first + 2});
  }
  return surface;
}

TEST(MendSurface, WallsThroughABodyLeaveItsFacesWhole) {
  const SurfaceMesh body = testing::icosphere(1);
  testing::Random random(7);
  int whole = 0;
  for (int i = 0; i < 13; ++i) {
    SurfaceMesh soup = body;
    for (int wall = 0; wall < 4; ++wall) {
      const Vec3 normal{random.unit() - 0.5, random.unit() - 0.5, random.unit() - 0.5};
      soup = with_a_wall(soup, body, normal, 0.3 * length(normal) * random.unit());
    }
    whole += mended(soup).surface.triangles.size() == body.triangles.size();
  }
  EXPECT_GE(whole, 12);  // the third one keeps its cuts
}

/// A triangle divided inside, the inner triangle turned half way round and tilted: three layers that cross.
SurfaceMesh with_a_crumple(SurfaceMesh surface, std::size_t t, double height) {
  const auto [a, b, c] = surface.triangles[t];
  const Vec3 p = surface.points[a], q = surface.points[b], r = surface.points[c], m = (p + q + r) / 3;
  const Vec3 up = normalized(cross(q - p, r - p)) * height;
  const auto first = static_cast<VertexIndex>(surface.points.size());
  surface.points.insert(surface.points.end(),
                        {m - (p - m) * 0.4 + up, m - (q - m) * 0.4 - up * 0.7, m - (r - m) * 0.4 - up * 0.4});
  const VertexIndex d = first, e = first + 1, f = first + 2;
  surface.patch.clear();
  surface.triangles[t] = {a, b, e};
  for (const Triangle& more : {Triangle{a, e, d}, {b, c, f}, {b, f, e}, {c, a, d}, {c, d, f}, {d, e, f}})
    surface.triangles.push_back(more);
  return surface;
}

TEST(MendSurface, CrumplesWithinTheToleranceAreLaidFlat) {
  const SurfaceMesh clean = box_at({}, {1, 1, 1}, 4);
  SurfaceMesh soup = with_a_crumple(with_a_crumple(clean, 3, 3e-4), 40, 5e-4);
  ASSERT_FALSE(find_defects(repair_surface(soup)).clean());
  const Mended result = mended(soup);
  EXPECT_EQ(result.report.count(Kind::kLaidFlat), 2u);
  EXPECT_EQ(result.surface.triangles.size(), clean.triangles.size());
  EXPECT_NEAR(enclosed_volume(result.surface), 1, 1e-14);
  EXPECT_NEAR(area(result.surface), 6, 1e-14);
  EXPECT_GT(result.report.largest_move, 2e-4);
  EXPECT_LT(result.report.largest_move, result.report.tolerance);
}

TEST(MendSurface, CrumplesBesideSharpEdgesAreLaidFlatWithoutThem) {
  SurfaceMesh soup = with_a_crumple(box_at({}, {1, 1, 1}, 1), 8, 0);
  const auto first = soup.points.size() - 3;
  const auto [a, b, c] = box_at({}, {1, 1, 1}, 1).triangles[8];
  const std::array<Vec3, 3> corners{soup.points[a], soup.points[b], soup.points[c]};
  const Vec3 middle = (corners[0] + corners[1] + corners[2]) / 3;
  const Vec3 normal = normalized(cross(corners[1] - corners[0], corners[2] - corners[0]));
  // Turned by less than half: of the triangle's own faces only some cross, and more lie beyond sharp edges.
  const std::array<double, 3> heights{-4e-5, -2.2e-4, 2.9e-4};
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 arm = corners[k] - middle;
    soup.points[first + k] = middle + (arm * -0.17 + cross(normal, arm) * 0.98) * 0.45 + normal * heights[k];
  }
  ASSERT_FALSE(find_defects(repair_surface(soup)).clean());
  const Mended result = mended(soup);
  EXPECT_EQ(result.report.count(Kind::kLaidFlat), 1u);
  EXPECT_EQ(result.surface.triangles.size(), 12u);
  EXPECT_NEAR(area(result.surface), 6, 1e-14);
}

TEST(MendSurface, CrumplesBeyondTheToleranceStay) {
  const SurfaceMesh soup = with_a_crumple(box_at({}, {1, 1, 1}, 4), 3, 0.01);
  const Mended result = mended(soup);
  EXPECT_EQ(result.report.count(Kind::kLaidFlat), 0u);
  EXPECT_GT(result.report.crossing_pairs, 0u);
}

TEST(MendSurface, BodiesThatOverlapWithinTheToleranceAreUnitedNotLaidFlat) {
  const Mended result =
      mended(testing::joined(box_at({}, {1, 1, 1}, 4), box_at({0.2, 0.2, 0.9995}, {0.3, 0.3, 0.5}, 2)));
  EXPECT_EQ(result.report.count(Kind::kLaidFlat), 0u);
  EXPECT_EQ(result.report.bodies, 1u);
}

TEST(MendSurface, FacesThatArePartlyCoveredStayDivided) {
  const Mended result = mended(testing::joined(box_at({}, {1, 1, 1}), box_at({0.3, 0.3, 0.5}, {0.2, 0.2, 1})));
  EXPECT_NEAR(enclosed_volume(result.surface), 1.02, 1e-12);
  EXPECT_GT(result.surface.triangles.size(), 24u);
}

double least_height(const SurfaceMesh& surface) {
  double least = HUGE_VAL;
  for (const auto& [a, b, c] : surface.triangles) {
    const Vec3 p = surface.points[a], q = surface.points[b], r = surface.points[c];
    least = std::min(least, length(cross(q - p, r - p)) / std::max({distance(p, q), distance(q, r), distance(r, p)}));
  }
  return least;
}

TEST(MendSurface, CutsThatNearlyMeetLeaveNoDust) {
  // The second box begins 1e-9 beside an edge of the triangulation of the first one, and ends as near to its corner.
  const SurfaceMesh soup =
      testing::joined(box_at({}, {1, 1, 1}, 4), box_at({0.25 + 1e-9, 0.25 - 1e-9, 0.5}, {0.5, 0.5 + 2e-9, 1}));
  const Mended result = mended(soup);
  EXPECT_GT(least_height(result.surface), 1e-7);
  EXPECT_NEAR(enclosed_volume(result.surface), 1.125, 1e-7);
}

TEST(MendSurface, SheetsAreRefusedWithWords) {
  SurfaceMesh terrain;
  constexpr int n = 8;
  for (int y = 0; y <= n; ++y)
    for (int x = 0; x <= n; ++x) terrain.points.push_back({double(x), double(y), 0.3 * std::sin(x) * std::cos(y)});
  for (VertexIndex y = 0; y < n; ++y)
    for (VertexIndex x = 0; x < n; ++x) {
      const VertexIndex a = y * (n + 1) + x, b = a + 1, c = a + n + 1, d = c + 1;
      terrain.triangles.push_back({a, b, d});
      terrain.triangles.push_back({a, d, c});
    }
  try {
    mend_surface(terrain);
    FAIL() << "a terrain encloses nothing";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("encloses nothing"), std::string::npos);
  }
  const Mended wrap = mended(terrain, wrap_at(0.3));
  EXPECT_EQ(wrap.report.bodies, 1u);
  const TriangleTree tree(terrain);
  for (const Vec3 p : wrap.surface.points) {
    const double away = std::sqrt(tree.nearest(p).squared_distance);
    EXPECT_NEAR(away, 0.3, 0.1);
  }
}

TEST(MendSurface, SoupsOfAnyKindEnd) {
  for (const int n : {1, 5, 60}) {
    SurfaceMesh soup;
    std::uint64_t state = static_cast<std::uint64_t>(n);
    const auto random = [&] {
      state = state * 6364136223846793005u + 1442695040888963407u;
      return static_cast<double>(state >> 40) / (1u << 24);
    };
    for (int t = 0; t < n; ++t) {
      const auto first = static_cast<VertexIndex>(soup.points.size());
      for (int i = 0; i < 3; ++i) soup.points.push_back({random(), random(), random()});
      soup.triangles.push_back({first, first + 1, first + 2});
    }
    try {
      mended(soup);
    } catch (const InputError&) {
    }
  }
}

// A thin cylinder of needles, each with corners of its own: around it edges are no longer than the gaps.
TEST(MendSurface, LooseTrianglesAreNotCalledASheet) {
  SurfaceMesh loose;
  testing::Random random(1);
  const auto add = [&](std::array<Vec3, 3> corners) {
    const auto first = static_cast<VertexIndex>(loose.points.size());
    for (const Vec3 p : corners) {
      const double x = random.between(-1, 1), y = random.between(-1, 1), z = random.between(-1, 1);
      loose.points.push_back(p + Vec3{x, y, z} * 4e-4);
    }
    loose.triangles.push_back({first, first + 1, first + 2});
  };
  const auto at = [](int k, double z) {
    return Vec3{0.03 * std::cos(k * std::numbers::pi / 90), 0.03 * std::sin(k * std::numbers::pi / 90), z};
  };
  for (int k = 0; k < 180; ++k) {
    add({at(k, 0), at(k + 1, 0), at(k + 1, 1)});
    add({at(k, 0), at(k + 1, 1), at(k, 1)});
    add({at(k + 1, 0), at(k, 0), {0, 0, 0}});
    add({at(k, 1), at(k + 1, 1), {0, 0, 1}});
  }
  try {
    mended(loose);
    FAIL() << "mended: a soup that is not is wanted here";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("do not hang together"), std::string::npos) << error.what();
  }
}

TEST(MendSurface, ThreadsChangeNothing) {
  SurfaceMesh soup =
      testing::joined(testing::torus(30, 12), testing::transformed(testing::icosphere(3), 0.7, {1, 0, 0}));
  soup = without(soup, [](Vec3 p) { return p.x < -1.2 && p.y > 0; });
  std::vector<Mended> results;
  for (const int threads : {1, 4}) {
    const ThreadLimit limit(threads);
    results.push_back(mended(soup));
  }
  EXPECT_EQ(results[0].surface, results[1].surface);
  EXPECT_EQ(to_json(results[0].report), to_json(results[1].report));
}

TEST(MendSurface, OptionsOutOfRangeAreRefused) {
  EXPECT_THROW(mend_surface(testing::cube(1), within(-1)), OptionError);
  EXPECT_THROW(mend_surface(testing::cube(1), wrap_at(0)), OptionError);
}

TEST(MendReportJson, HasEveryChangeWithItsPlace) {
  const Mended result = mended(without(testing::cube(2), [](Vec3 p) { return p.z == 1; }));
  const auto json = nlohmann::json::parse(to_json(result.report));
  EXPECT_FALSE(json["clean"]);
  ASSERT_EQ(json["changes"].size(), result.report.changes.size());
  EXPECT_EQ(json["changes"][0]["kind"], "closed");
  EXPECT_EQ(json["changes"][0]["at"].size(), 3u);
}

}  // namespace
}  // namespace octafront
