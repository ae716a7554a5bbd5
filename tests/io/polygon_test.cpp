#include "io/polygon.h"

#include "geometry/predicates.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace octafront::io {
namespace {

using Pieces = std::vector<std::array<std::uint32_t, 3>>;

double plane_area(const std::vector<Vec3>& p) {
  double twice = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Vec3 a = p[i], b = p[(i + 1) % p.size()];
    twice += a.x * b.y - a.y * b.x;
  }
  return twice / 2;
}

/// Oracle: n - 2 triangles, all turning like the polygon, whose areas add up to its own. Then none can overlap.
void expect_divided(const std::vector<Vec3>& p) {
  Pieces pieces;
  EXPECT_TRUE(triangulate_polygon(p, pieces));
  EXPECT_EQ(pieces.size(), p.size() - 2);
  double sum = 0;
  for (const auto& [a, b, c] : pieces) {
    EXPECT_EQ(orient2d(p[a].x, p[a].y, p[b].x, p[b].y, p[c].x, p[c].y), 1);
    sum += plane_area({p[a], p[b], p[c]});
  }
  EXPECT_NEAR(sum, plane_area(p), 1e-9 * std::abs(plane_area(p)));
}

TEST(Polygon, TriangleStaysAsItIs) {
  Pieces pieces;
  EXPECT_TRUE(triangulate_polygon(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, pieces));
  EXPECT_EQ(pieces, (Pieces{{0, 1, 2}}));
}

TEST(Polygon, ConvexBecomesAFan) {
  Pieces pieces;
  EXPECT_TRUE(triangulate_polygon(std::vector<Vec3>{{0, 0, 5}, {0, 1, 5}, {1, 1, 5}, {1, 0, 5}}, pieces));
  EXPECT_EQ(pieces, (Pieces{{0, 1, 2}, {0, 2, 3}}));
}

TEST(Polygon, DartsAndCornersOnStraightSides) {
  expect_divided({{0, 0, 0}, {2, 1, 0}, {0, 2, 0}, {1, 1, 0}});
  expect_divided({{1, 1, 0}, {0, 0, 0}, {2, 1, 0}, {0, 2, 0}});
  expect_divided({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}});
  expect_divided({{0, 0, 0}, {.5, 0, 0}, {1, 0, 0}, {0, 1, 0}});
}

TEST(Polygon, HoleCutOpenAlongADoubledEdge) {
  // A square with a square hole, joined by the edge (0,0)-(1,1) that is run through twice.
  expect_divided(
      {{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}, {0, 0, 0}, {1, 1, 0}, {1, 2, 0}, {2, 2, 0}, {2, 1, 0}, {1, 1, 0}});
}

TEST(Polygon, RandomStarsInEveryDirection) {
  std::mt19937 random(20240);
  std::uniform_real_distribution<double> radius(0.1, 1);
  for (int n = 4; n < 60; ++n) {
    std::vector<Vec3> star;
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * i / n, r = radius(random);
      star.push_back({r * std::cos(angle), r * std::sin(angle), 0});
    }
    expect_divided(star);
    // Seen along another axis, and from behind, the same triangles result up to their first corner.
    std::vector<Vec3> turned;
    for (const Vec3& p : star) turned.push_back({p.y, 3, p.x});
    Pieces flat, upright;
    triangulate_polygon(star, flat);
    triangulate_polygon(turned, upright);
    EXPECT_EQ(flat, upright);
  }
}

TEST(Polygon, SpiralsAndCombs) {
  std::vector<Vec3> spiral, comb;
  for (int i = 0; i < 200; ++i)
    spiral.push_back({(1 + .05 * i) * std::cos(.2 * i), (1 + .05 * i) * std::sin(.2 * i), 0});
  for (int i = 199; i >= 0; --i)
    spiral.push_back({(.7 + .05 * i) * std::cos(.2 * i), (.7 + .05 * i) * std::sin(.2 * i), 0});
  for (Vec3& p : spiral) p.x = -p.x;  // counter-clockwise
  std::vector<Vec3> other(spiral.rbegin(), spiral.rend());
  expect_divided(plane_area(spiral) > 0 ? spiral : other);
  for (int i = 0; i < 100; ++i) comb.push_back({double(i), i % 2 == 0 ? 0.0 : 9.0, 0});
  comb.push_back({99, 10, 0});
  comb.push_back({0, 10, 0});
  expect_divided(comb);
}

TEST(Polygon, CrossingSidesAreToldAndStillEnd) {
  Pieces pieces;
  EXPECT_FALSE(triangulate_polygon(std::vector<Vec3>{{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 2, 0}, {-1, 1, 0}}, pieces));
  EXPECT_EQ(pieces.size(), 3U);
}

TEST(Polygon, EqualNeighboursAreLeftOut) {
  Pieces pieces;
  EXPECT_TRUE(triangulate_polygon(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}}, pieces));
  EXPECT_EQ(pieces.size(), 1U);
  pieces.clear();
  EXPECT_TRUE(triangulate_polygon(std::vector<Vec3>(5, Vec3{1, 2, 3}), pieces));
  EXPECT_TRUE(pieces.empty());
}

TEST(Polygon, LargeOnesEndSoon) {
  std::vector<Vec3> gear;
  for (int i = 0; i < 20000; ++i) {
    const double angle = 2 * std::numbers::pi * i / 20000, r = i % 2 == 0 ? 1 : .9;
    gear.push_back({r * std::cos(angle), r * std::sin(angle), 0});
  }
  expect_divided(gear);
}

}  // namespace
}  // namespace octafront::io
