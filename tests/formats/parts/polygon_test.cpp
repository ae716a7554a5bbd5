
#include "formats/parts/polygon.h"

#include "base/geometry/predicates.h"

#include <algorithm>
#include <cmath>
#include <deque>
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

/// The triangles that ear clipping makes where every corner left is looked at for every ear.
Pieces clipped_slowly(const std::vector<Vec3>& p) {
  std::deque<std::uint32_t> waiting;
  std::vector<std::uint32_t> left;
  for (std::uint32_t i = 0; i < p.size(); ++i) {
    waiting.push_back(i);
    left.push_back(i);
  }
  Pieces pieces;
  const auto turn = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    return orient2d(p[a].x, p[a].y, p[b].x, p[b].y, p[c].x, p[c].y);
  };
  while (left.size() > 3) {
    const std::uint32_t i = waiting.front();
    waiting.pop_front();
    const auto at = std::find(left.begin(), left.end(), i);
    if (at == left.end()) continue;
    const std::uint32_t a = at == left.begin() ? left.back() : at[-1], c = at + 1 == left.end() ? left.front() : at[1];
    const auto blocks = [&](std::uint32_t k) {
      return k != a && k != i && k != c && turn(a, i, k) >= 0 && turn(i, c, k) >= 0 && turn(c, a, k) >= 0;
    };
    if (turn(a, i, c) <= 0 || std::any_of(left.begin(), left.end(), blocks)) continue;
    pieces.push_back({a, i, c});
    left.erase(at);
    waiting.push_back(a);
    waiting.push_back(c);
  }
  // The last ear's neighbour behind comes first.
  const auto next = std::find(left.begin(), left.end(), pieces.back()[2]) - left.begin();
  pieces.push_back({left[(next + 2) % 3], left[next], left[(next + 1) % 3]});
  return pieces;
}

TEST(Polygon, TheTreeOfBlockersChangesNothing) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> radius(0.3, 1);
  for (const int n : {40, 300, 1000}) {
    std::vector<Vec3> star;
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * i / n, r = radius(random);
      star.push_back({r * std::cos(angle), r * std::sin(angle), 0});
    }
    Pieces pieces;
    ASSERT_TRUE(triangulate_polygon(star, pieces));
    EXPECT_EQ(pieces, clipped_slowly(star)) << n;
  }
}

TEST(Polygon, LargeOnesEndSoon) {
  std::vector<Vec3> gear;
  constexpr int kCorners = 200000;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2 * std::numbers::pi * i / kCorners, r = i % 2 == 0 ? 1 : .9;
    gear.push_back({r * std::cos(angle), r * std::sin(angle), 0});
  }
  expect_divided(gear);
}

}  // namespace
}  // namespace octafront::io
