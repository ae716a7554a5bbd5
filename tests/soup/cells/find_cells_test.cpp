#include "soup/cells/find_cells.h"

#include "base/geometry/winding_number.h"
#include "soup/arrangement/arrange.h"
#include "support/complexes.h"
#include "support/named_surfaces.h"
#include "support/random.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace octafront {
namespace {

/// Regions of a complex and cells of its walls are the same things.
void expect_cells_are_regions(const testing::KnownComplex& known) {
  SCOPED_TRACE(known.name);
  const SurfaceMesh& s = known.surface;
  const Cells cells(s.points, s.triangles);
  ASSERT_EQ(cells.count(), known.volumes.size() + 1);
  std::vector<std::uint32_t> region(cells.count(), kNone);
  for (std::size_t t = 0; t < s.triangles.size(); ++t)
    for (const std::size_t side : {0, 1}) {
      const std::uint32_t wanted = s.sides[t][side], cell = cells.sides_of(t)[side];
      ASSERT_EQ(cell == 0, wanted == kNone);
      if (cell == 0) continue;
      if (region[cell] == kNone) region[cell] = wanted;
      ASSERT_EQ(region[cell], wanted);
    }
  const std::vector<double> volumes = cells.volumes();
  for (std::size_t c = 1; c < volumes.size(); ++c) EXPECT_NEAR(volumes[c], known.volumes[region[c]], 1e-12);
}

TEST(Cells, AreTheRegionsOfKnownComplexes) {
  for (const testing::KnownComplex& known : testing::known_complexes()) expect_cells_are_regions(known);
}

TEST(Cells, AreTheRegionsOfRandomComplexes) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    expect_cells_are_regions(testing::foam(static_cast<int>(5 + seed), seed));
    expect_cells_are_regions(testing::plane_cuts(static_cast<int>(1 + seed % 9), seed));
  }
}

TEST(Cells, DoNotCareWhichWayTrianglesFace) {
  SurfaceMesh s = testing::foam(30, 3).surface;
  std::vector<double> a = Cells(s.points, s.triangles).volumes();
  testing::Random random(1);
  for (Triangle& t : s.triangles)
    if (random.unit() < 0.5) std::swap(t[0], t[1]);
  std::vector<double> b = Cells(s.points, s.triangles).volumes();
  ASSERT_EQ(a.size(), b.size());
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  for (std::size_t c = 0; c < a.size(); ++c) EXPECT_NEAR(a[c], b[c], 1e-15);
}

TEST(Cells, ALineThroughVerticesAndEdgesCountsRight) {
  // Cubes in cubes about one centre: lines through a centre of a face run through edges of all.
  SurfaceMesh nested = testing::transformed(testing::cube(2), 1, {-0.5, -0.5, -0.5});
  for (const double scale : {2.0, 4.0, 8.0})
    nested =
        testing::joined(nested, testing::transformed(testing::cube(2), scale, {-scale / 2, -scale / 2, -scale / 2}));
  const Cells cells(nested.points, nested.triangles);
  ASSERT_EQ(cells.count(), 5U);
  EXPECT_NEAR(cells.volumes()[cells.sides_of(0)[1]], 1, 1e-12);
  EXPECT_EQ(cells.at({0, 0, 0}), std::optional(cells.sides_of(0)[1]));
  EXPECT_EQ(cells.at({0, 0, 5}), std::optional(0u));
  EXPECT_EQ(cells.at({0, 0, 0.5}), std::nullopt);
}

TEST(Cells, OfRandomSoupsFitThroughEveryWall) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(seed);
    testing::Random random(seed);
    SurfaceMesh soup;
    for (int t = 0; t < 25; ++t) {
      for (int k = 0; k < 3; ++k) {
        const double x = random.unit(), y = random.unit(), z = random.unit();
        soup.points.push_back({x, y, z});
      }
      const auto last = static_cast<VertexIndex>(soup.points.size());
      soup.triangles.push_back({last - 3, last - 2, last - 1});
    }
    const Arrangement arranged = arrange(soup.points, soup.triangles);
    const Cells cells(arranged.points, arranged.triangles);
    for (std::uint32_t c = 1; c < cells.count(); ++c) EXPECT_GT(cells.volumes()[c], 0);
    // A point beside a face lies in the cell on that side.
    for (std::size_t t = 0; t < arranged.triangles.size(); ++t) {
      const auto [a, b, c] = arranged.triangles[t];
      const Vec3 p = arranged.points[a], q = arranged.points[b], r = arranged.points[c];
      const Vec3 n = cross(q - p, r - p);
      if (length(n) < 1e-4) continue;
      const Vec3 middle = (p + q + r) / 3;
      for (const double side : {1.0, -1.0})
        if (const auto cell = cells.at(middle + side * 1e-9 * normalized(n))) {
          EXPECT_EQ(*cell, cells.sides_of(t)[side > 0 ? 0 : 1]);
        }
    }
  }
}

TEST(Cells, AHoleLetsTheInsideOut) {
  SurfaceMesh s = testing::icosphere(2);
  s.triangles.erase(s.triangles.begin() + 17);
  const Cells cells(s.points, s.triangles);
  EXPECT_EQ(cells.count(), 1U);
  const std::vector<Vec3> way = cells.way({0, 0, 0}, std::nullopt);
  ASSERT_GT(way.size(), 2U);
  EXPECT_EQ(way.front(), (Vec3{0, 0, 0}));
}

}  // namespace
}  // namespace octafront
