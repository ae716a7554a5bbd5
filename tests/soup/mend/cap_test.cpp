#include "base/geometry/measures.h"
#include "soup/mend/caps.h"

#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

namespace octafront::mend {
namespace {

bool no_edge_is_there(std::uint32_t, std::uint32_t) {
  return false;
}

std::vector<Vec3> circle(int n) {
  std::vector<Vec3> points;
  for (int i = 0; i < n; ++i) {
    const double a = 2 * std::numbers::pi * i / n;
    points.push_back({std::cos(a), std::sin(a), 0});
  }
  return points;
}

double area_of(const Cap& cap, const std::vector<Vec3>& points) {
  double area = 0;
  for (const auto& [a, b, c] : cap) area += triangle_area(points[a], points[b], points[c]);
  return area;
}

double polygon_area(const std::vector<Vec3>& points) {
  double twice = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 p = points[i], q = points[(i + 1) % points.size()];
    twice += p.x * q.y - p.y * q.x;
  }
  return twice / 2;
}

TEST(TriangulatePolygon, CoversPlanePolygonsOnce) {
  for (const int n : {3, 4, 17, 256, 257, 1000}) {
    const std::vector<Vec3> points = circle(n);
    const Cap cap = triangulate_polygon(points, std::vector<Vec3>(points.size()), no_edge_is_there);
    EXPECT_EQ(cap.size(), points.size() - 2);
    EXPECT_NEAR(area_of(cap, points), polygon_area(points), 1e-12);
    for (const auto& [a, b, c] : cap) EXPECT_GT(double_area_normal(points[a], points[b], points[c]).z, 0);
  }
}

TEST(TriangulatePolygon, FollowsTheRim) {
  std::vector<Vec3> points;  // an L
  for (const auto& [x, y] : {std::pair{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}})
    points.push_back({double(x), double(y), 0});
  const Cap cap = triangulate_polygon(points, std::vector<Vec3>(points.size()), no_edge_is_there);
  EXPECT_NEAR(area_of(cap, points), 5, 1e-12);
}

/// A square bent along either diagonal: what lies beyond decides.
TEST(TriangulatePolygon, BendsAsLittleAsItCan) {
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 1}, {1, 1, 0}, {0, 1, 1}};
  const auto has_edge = [](const Cap& cap, std::uint32_t a, std::uint32_t b) {
    for (const auto& t : cap) {
      const std::set<std::uint32_t> corners(t.begin(), t.end());
      if (corners.contains(a) && corners.contains(b)) return true;
    }
    return false;
  };
  const Vec3 n = normalized(double_area_normal(points[0], points[1], points[2]));
  const Vec3 m = normalized(double_area_normal(points[0], points[2], points[3]));
  EXPECT_TRUE(has_edge(triangulate_polygon(points, std::vector<Vec3>{n, n, m, m}, no_edge_is_there), 0, 2));
  const Vec3 k = normalized(double_area_normal(points[0], points[1], points[3]));
  const Vec3 l = normalized(double_area_normal(points[1], points[2], points[3]));
  EXPECT_TRUE(has_edge(triangulate_polygon(points, std::vector<Vec3>{k, l, l, k}, no_edge_is_there), 1, 3));
}

TEST(TriangulatePolygon, LeavesEdgesAloneThatAreThere) {
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  for (const std::uint32_t first : {0u, 1u}) {
    const Cap cap = triangulate_polygon(points, std::vector<Vec3>(4), [&](std::uint32_t a, std::uint32_t b) {
      return std::min(a, b) == first && std::max(a, b) == first + 2;
    });
    std::set<std::uint32_t> shared;
    for (const std::uint32_t v : cap[0])
      for (const std::uint32_t w : cap[1])
        if (v == w) shared.insert(v);
    EXPECT_EQ(shared, (first == 0 ? std::set<std::uint32_t>{1, 3} : std::set<std::uint32_t>{0, 2}));
  }
}

}  // namespace
}  // namespace octafront::mend
