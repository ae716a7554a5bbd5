#include <octafront/mend.h>

#include "base/mesh/edge_table.h"
#include "soup/mend/caps.h"
#include "support/named_surfaces.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace octafront::mend {
namespace {

/// An upright wall along most of a circle, of `sides` parts of 16.
SurfaceMesh round_wall(int sides, double radius, double low, double high) {
  SurfaceMesh s;
  for (int i = 0; i < sides + 1; ++i) {
    const double a = 2 * std::numbers::pi * (i % 16) / 16;
    for (const double z : {low, high}) s.points.push_back({0.5 + radius * std::cos(a), 0.5 + radius * std::sin(a), z});
  }
  for (int i = 0; i < sides; ++i) {
    const auto at = [&](int k) { return static_cast<VertexIndex>((2 * i + k) % 32); };
    s.triangles.push_back({at(0), at(2), at(3)});
    s.triangles.push_back({at(0), at(3), at(1)});
  }
  if (sides == 16) s.points.resize(32);
  return s;
}

std::ptrdiff_t fin_triangles(const SurfaceMesh& soup) {
  const EdgeTable table = make_edge_table(soup.points.size(), soup.triangles);
  const std::vector<char> is_of_fin = triangles_of_fins(soup.triangles, table, find_loops(soup.triangles, table));
  return std::ranges::count(is_of_fin, 1);
}

SurfaceMesh cube_with_joined_fin() {
  SurfaceMesh soup = testing::cube(2);
  const auto [a, b, c] = soup.triangles.front();
  const Vec3 up{0.3, 0.4, 0.5};
  const auto first = static_cast<VertexIndex>(soup.points.size());
  soup.points.insert(soup.points.end(), {soup.points[a] + up, soup.points[b] + up});
  soup.triangles.insert(soup.triangles.end(), {{a, b, first + 1}, {a, first + 1, first}});
  return soup;
}

TEST(Fins, AreStripsWithNothingButRim) {
  EXPECT_EQ(fin_triangles(round_wall(15, 0.1, 0, 1)), 30);
  EXPECT_EQ(fin_triangles(cube_with_joined_fin()), 2);
}

TEST(Fins, AreNeitherTubesNorBodiesWithHoles) {
  EXPECT_EQ(fin_triangles(round_wall(16, 0.1, 0, 1)), 0);
  SurfaceMesh open = testing::cube(1);
  open.triangles.pop_back();
  EXPECT_EQ(fin_triangles(open), 0);
  EXPECT_EQ(fin_triangles(testing::cube(2)), 0);
}

// Its two ends and the slit are a sixth of it: it was closed and became a rod on the cube.
TEST(Fins, NearlyRoundOnesBecomeNoBodies) {
  const SurfaceMesh whole = testing::cube(3);
  const Mended mended = mend_surface(testing::joined(whole, round_wall(15, 0.1, 0.9, 1.9)));
  EXPECT_NEAR(enclosed_volume(mended.surface), 1, 1e-12);
  EXPECT_EQ(mended.report.count(MendChange::Kind::kClosed), 0u);
}

}  // namespace
}  // namespace octafront::mend
