#include "surface/lines/point_grid.h"

#include "base/core/random.h"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

namespace octafront::surface {
namespace {

struct Sized {
  Vec3 p;
  double size;
};

/// Points on a bumpy sheet around the origin, whose sizes double several times from one side of it to the other.
std::vector<Sized> graded_sheet() {
  octafront::Random random(7);
  std::vector<Sized> points;
  for (int i = 0; i < 4000; ++i) {
    const double x = 8 * random.unit() - 4, y = 8 * random.unit() - 4;
    points.push_back({{x, y, std::sin(x)}, 0.05 * std::exp2(0.5 * (x + 4) * (0.9 + 0.2 * random.unit()))});
  }
  return points;
}

/// What a query must find, and nothing farther than this or of a size that differs more.
TEST(PointGrid, FindsAllThatIsNear) {
  const std::vector<Sized> points = graded_sheet();
  PointGrid<int> grid({0.3, 0.2, 0.1});
  for (std::size_t i = 0; i < points.size(); ++i) {
    grid.add(points[i].p, points[i].size, static_cast<int>(i) + 1);
    if (i % 5 != 0) continue;  // between additions, too
    const auto [p, size] = points[i];
    for (const double reach : {0.7, 1.5}) {
      std::set<std::uint32_t> found;
      grid.for_each_near(p, size, reach, [&, p = p, size = size](const auto& e) {
        EXPECT_TRUE(found.insert(e.id).second);
        EXPECT_EQ(e.p, points[e.id].p);
        EXPECT_EQ(e.size, points[e.id].size);
        EXPECT_EQ(e.data, static_cast<int>(e.id) + 1);
        EXPECT_LE(std::abs(std::ilogb(size) - std::ilogb(e.size)), 1);
        EXPECT_LT(distance(e.p, p), 0.5 * reach * (size + 2 * e.size));
      });
      for (std::uint32_t j = 0; j <= i; ++j) {
        const bool is_near = distance(points[j].p, p) < 0.5 * reach * (size + points[j].size);
        const bool of_like_size = std::abs(std::ilogb(size) - std::ilogb(points[j].size)) <= 1;
        EXPECT_TRUE(!is_near || !of_like_size || found.contains(j)) << i << " does not find " << j;
      }
    }
  }
}

/// Sizes of three levels around one place: those beside the query's level are found on both sides.
TEST(PointGrid, FindsFinerAndCoarserPoints) {
  PointGrid<NoData> grid({0, 0, 0});
  for (const double size : {0.3, 0.6, 1.2, 2.4, 4.8}) grid.add({0.01 * size, 0, 0}, size);
  std::set<std::uint32_t> found;
  grid.for_each_near({0, 0, 0}, 1.2, 1, [&](const auto& e) { found.insert(e.id); });
  EXPECT_EQ(found, (std::set<std::uint32_t>{1, 2, 3}));
}

}  // namespace
}  // namespace octafront::surface
