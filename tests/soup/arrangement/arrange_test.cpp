#include "soup/arrangement/arrange.h"

#include "base/core/thread_limit.h"
#include "base/geometry/rational_oracle.h"
#include "base/geometry/self_intersection.h"
#include "support/named_surfaces.h"
#include "support/random.h"

#include <algorithm>
#include <functional>
#include <string>

#include <gtest/gtest.h>

namespace octafront {
namespace {

SurfaceMesh random_soup(std::uint64_t seed, int triangles, const std::function<Vec3(testing::Random&)>& point) {
  testing::Random random(seed);
  SurfaceMesh soup;
  for (int t = 0; t < triangles; ++t) {
    const auto first = static_cast<VertexIndex>(soup.points.size());
    for (int k = 0; k < 3; ++k) soup.points.push_back(point(random));
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

/// A small lattice: corners on edges, edges on edges, triangles in common planes.
SurfaceMesh lattice_soup(std::uint64_t seed, int triangles, int side) {
  return random_soup(seed, triangles, [side](testing::Random& r) {
    const int x = r.integer(0, side), y = r.integer(0, side), z = r.integer(0, side);
    return Vec3{1.0 * x, 1.0 * y, 1.0 * z};
  });
}

SurfaceMesh general_soup(std::uint64_t seed, int triangles) {
  return random_soup(seed, triangles, [](testing::Random& r) {
    const double x = r.unit(), y = r.unit(), z = r.unit();
    return Vec3{x, y, z};
  });
}

double area_of_triangle(const std::vector<Vec3>& points, const Triangle& t) {
  return length(cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]])) / 2;
}

Vec3 normal_of(const std::vector<Vec3>& points, const Triangle& t) {
  return cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]);
}

/// What must hold of every arrangement.
void expect_arranged(const SurfaceMesh& soup, const Arrangement& made) {
  EXPECT_TRUE(self_intersections(made.points, made.triangles).empty());
  ASSERT_EQ(made.first_origin.size(), made.triangles.size() + 1);
  for (std::size_t v = 0; v < soup.points.size(); ++v) EXPECT_EQ(made.points[v], soup.points[v]);
  std::vector<double> covered(soup.triangles.size(), 0);
  for (std::size_t t = 0; t < made.triangles.size(); ++t) {
    ASSERT_FALSE(made.origins_of(t).empty());
    EXPECT_FALSE(made.origins_of(t)[0].reversed);
    for (const Origin& o : made.origins_of(t)) {
      covered[o.triangle] += area_of_triangle(made.points, made.triangles[t]);
      const double turn =
          dot(normal_of(made.points, made.triangles[t]), normal_of(soup.points, soup.triangles[o.triangle]));
      if (area_of_triangle(made.points, made.triangles[t]) > 1e-9) {
        EXPECT_EQ(turn < 0, o.reversed);
      }
    }
  }
  for (std::size_t t = 0; t < soup.triangles.size(); ++t)
    EXPECT_NEAR(covered[t], area_of_triangle(soup.points, soup.triangles[t]), 1e-9) << "triangle " << t;
}

/// Corners of what each two triangles have in common are vertices of both.
void expect_oracle_agrees(const SurfaceMesh& soup, const Arrangement& made) {
  std::vector<std::vector<Vec3>> corners(soup.triangles.size());
  for (std::size_t t = 0; t < made.triangles.size(); ++t)
    for (const Origin& o : made.origins_of(t))
      for (const VertexIndex v : made.triangles[t]) corners[o.triangle].push_back(made.points[v]);
  const auto is_corner = [&](std::size_t t, Vec3 p) {
    return std::any_of(corners[t].begin(), corners[t].end(), [&](Vec3 q) { return distance(p, q) < 1e-12; });
  };
  const auto triangle = [&](std::size_t t) {
    const auto [a, b, c] = soup.triangles[t];
    return std::array<Vec3, 3>{soup.points[a], soup.points[b], soup.points[c]};
  };
  for (std::size_t s = 0; s < soup.triangles.size(); ++s)
    for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
      if (s == t || area_of_triangle(soup.points, soup.triangles[s]) == 0 ||
          area_of_triangle(soup.points, soup.triangles[t]) == 0)
        continue;
      std::vector<testing::RationalPoint> polygon;
      for (const Vec3 p : triangle(s)) polygon.push_back(testing::rational(p));
      for (const auto& [x, y, z, w] : testing::intersection_with_triangle(polygon, triangle(t))) {
        const auto over = [&](testing::Int i) { return static_cast<double>(i) / static_cast<double>(w); };
        const Vec3 p{over(x), over(y), over(z)};
        EXPECT_TRUE(is_corner(s, p) && is_corner(t, p)) << s << " and " << t;
      }
    }
}

TEST(Arrange, SoupsOnALatticeAgreeWithTheOracle) {
  for (std::uint64_t seed = 1; seed <= 150; ++seed) {
    SCOPED_TRACE(seed);
    const SurfaceMesh soup = lattice_soup(seed, 12, seed % 3 == 0 ? 2 : seed % 3 == 1 ? 4 : 9);
    const Arrangement made = arrange(soup.points, soup.triangles);
    expect_arranged(soup, made);
    expect_oracle_agrees(soup, made);
  }
}

TEST(Arrange, SoupsInGeneralPosition) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    const SurfaceMesh soup = general_soup(seed, 60);
    const Arrangement made = arrange(soup.points, soup.triangles);
    EXPECT_GT(made.crossing_pairs, 100U);
    expect_arranged(soup, made);
  }
}

TEST(Arrange, AFlatSoupIsOneFacet) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(seed);
    // A plane that no axis sees as it is; small integers keep it exact.
    const SurfaceMesh soup = random_soup(seed, 30, [](testing::Random& r) {
      const int x = r.integer(0, 9), y = r.integer(0, 9);
      return Vec3{1.0 * x, 1.0 * y, 2.0 * x - 3.0 * y};
    });
    expect_arranged(soup, arrange(soup.points, soup.triangles));
  }
}

TEST(Arrange, WhatDoesNotCrossStaysAsItIs) {
  const SurfaceMesh sphere = testing::icosphere(3);
  const Arrangement made = arrange(sphere.points, sphere.triangles);
  EXPECT_EQ(made.points, sphere.points);
  EXPECT_EQ(made.triangles, sphere.triangles);
  EXPECT_EQ(made.crossing_pairs, 0U);
}

TEST(Arrange, TrianglesAwayFromCrossingsKeepTheirCorners) {
  const SurfaceMesh two =
      testing::joined(testing::icosphere(3), testing::transformed(testing::icosphere(3), 1, {1.7, 0, 0}));
  const Arrangement made = arrange(two.points, two.triangles);
  std::size_t kept = 0;
  for (std::size_t t = 0; t < made.triangles.size(); ++t)
    kept += made.triangles[t] == two.triangles[made.origins_of(t)[0].triangle];
  EXPECT_GT(kept, two.triangles.size() * 8 / 10);
  EXPECT_GT(made.new_points, 20U);
  expect_arranged(two, made);
}

TEST(Arrange, CopiesBecomeOneTriangleWithManyOrigins) {
  const SurfaceMesh cube = testing::cube(2);
  const SurfaceMesh thrice = testing::joined(testing::joined(cube, cube), testing::reversed(cube));
  const Arrangement made = arrange(thrice.points, thrice.triangles);
  EXPECT_EQ(made.triangles.size(), cube.triangles.size());
  for (std::size_t t = 0; t < made.triangles.size(); ++t) {
    ASSERT_EQ(made.origins_of(t).size(), 3U);
    EXPECT_TRUE(made.origins_of(t)[2].reversed);
  }
}

TEST(Arrange, TheSameOnAnyNumberOfThreads) {
  const SurfaceMesh soup = general_soup(5, 120);
  std::vector<Arrangement> made;
  for (const int threads : {1, 4}) {
    const ThreadLimit limit(threads);
    made.push_back(arrange(soup.points, soup.triangles));
  }
  EXPECT_EQ(made[0].points, made[1].points);
  EXPECT_EQ(made[0].triangles, made[1].triangles);
  EXPECT_EQ(made[0].origins, made[1].origins);
}

/// Skins a rounding apart cross in slivers, which rounding would make more of.
TEST(Arrange, SkinsDoubledWithinRoundingEnd) {
  SurfaceMesh soup = testing::torus(30, 12);
  const SurfaceMesh one = soup;
  for (const Vec3 p : one.points) soup.points.push_back(p * (1 + 1e-15));
  const auto first = static_cast<VertexIndex>(one.points.size());
  for (const auto& [a, b, c] : one.triangles) soup.triangles.push_back({first + a, first + b, first + c});
  ASSERT_FALSE(self_intersections(soup.points, soup.triangles, 1).empty());
  const Arrangement made = arrange(soup.points, soup.triangles);
  EXPECT_TRUE(self_intersections(made.points, made.triangles).empty());
  EXPECT_GT(made.largest_move, 0);
  EXPECT_LT(made.largest_move, 1e-11);
  EXPECT_LT(made.triangles.size(), 2 * soup.triangles.size());
}

/// Thirty triangles on a lattice of thirds, found by fuzzing: rounding made ever more crossings of them.
TEST(Arrange, ASoupThatRoundingDidNotSettleEnds) {
  const std::string thirds =
      "301000020000100230102032333333333333333333333333333333333333033333333333333333333333333333"
      "333333333333333200033333333333333333303311120210001202012300230001330133232200000022010002"
      "100022000333333333333333333333333333333333333333333333333333333330022200300210031010223023";
  SurfaceMesh soup;
  for (std::size_t i = 0; i < thirds.size(); i += 3) {
    const auto at = [&](std::size_t k) { return 1.0 / 3 * (thirds[i + k] - '0'); };
    soup.points.push_back({at(0), at(1), at(2)});
    const auto n = static_cast<VertexIndex>(soup.points.size());
    if (n % 3 == 0) soup.triangles.push_back({n - 3, n - 2, n - 1});
  }
  const Arrangement made = arrange(soup.points, soup.triangles);
  EXPECT_TRUE(self_intersections(made.points, made.triangles).empty());
  EXPECT_LT(made.passes, 12);
}

/// Triangles turned against each other by so little that their crossings are long and thin.
TEST(Arrange, NearlyParallelFacesEnd) {
  for (const double turn : {1e-5, 1e-9, 1e-13, 3e-16}) {
    SurfaceMesh soup;
    testing::Random random(7);
    for (int k = 0; k < 12; ++k) {
      const auto first = static_cast<VertexIndex>(soup.points.size());
      for (int i = 0; i < 3; ++i) {
        const double x = random.unit(), y = random.unit();
        soup.points.push_back({x, y, turn * k * (x - y + 0.1 * random.unit())});
      }
      soup.triangles.push_back({first, first + 1, first + 2});
    }
    const Arrangement made = arrange(soup.points, soup.triangles);
    EXPECT_TRUE(self_intersections(made.points, made.triangles).empty()) << turn;
  }
}

}  // namespace
}  // namespace octafront
