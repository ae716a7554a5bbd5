#include "base/geometry/measures.h"
#include "soup/mend/caps.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

namespace octafront::mend {
namespace {

bool no_edge_is_taken(std::uint32_t, std::uint32_t) {
  return false;
}

/// A circle of latitude on the unit sphere, and spokes to the next one away from the pole.
struct Calotte {
  std::vector<Vec3> rim;
  std::vector<Spoke> beyond;
};
Calotte calotte(double angle, int n) {
  Calotte made;
  const double step = 2 * std::numbers::pi / n;
  const auto at = [&](double down, double i) {
    return Vec3{std::sin(down) * std::cos(step * i), std::sin(down) * std::sin(step * i), std::cos(down)};
  };
  for (int i = 0; i < n; ++i) {
    made.rim.push_back(at(angle, i));
    for (const double side : {-0.5, 0.5})
      made.beyond.emplace_back(static_cast<std::uint32_t>(i), at(angle + step * std::sin(angle), i + side));
  }
  return made;
}

TEST(Faired, GoesOnAsTheSurfaceAroundIt) {
  for (const double angle : {0.3, 0.6}) {
    const Calotte hole = calotte(angle, 40);
    const Cap flat = triangulate_polygon(hole.rim, std::vector<Vec3>(hole.rim.size()), no_edge_is_taken);
    const FairCap cap = faired(hole.rim, flat, hole.beyond, no_edge_is_taken, 4000);
    ASSERT_GT(cap.inner.size(), 20u);
    const double rise = 1 - std::cos(angle);
    double highest = -1, farthest = 0;
    for (const Vec3 p : cap.inner) {
      highest = std::max(highest, p.z);
      farthest = std::max(farthest, std::abs(length(p) - 1));
    }
    EXPECT_NEAR(highest, 1, 0.35 * rise) << angle;
    EXPECT_LT(farthest, 0.35 * rise) << angle;
  }
}

TEST(Faired, IsOneDiscAlongTheRim) {
  const Calotte hole = calotte(0.5, 31);
  const Cap flat = triangulate_polygon(hole.rim, std::vector<Vec3>(hole.rim.size()), no_edge_is_taken);
  const FairCap cap = faired(hole.rim, flat, hole.beyond, no_edge_is_taken, 4000);
  std::map<std::array<std::uint32_t, 2>, int> sides;
  for (const auto& t : cap.triangles)
    for (std::size_t i = 0; i < 3; ++i) ++sides[{t[i], t[(i + 1) % 3]}];
  std::size_t open = 0;
  for (const auto& [side, times] : sides) {
    EXPECT_EQ(times, 1);
    if (sides.contains({side[1], side[0]})) continue;
    ++open;
    EXPECT_EQ((side[0] + 1) % hole.rim.size(), side[1]);
  }
  EXPECT_EQ(open, hole.rim.size());
  EXPECT_EQ(cap.triangles.size(), hole.rim.size() - 2 + 2 * cap.inner.size());
}

TEST(Faired, FewerPointsWhereTheRimIsFine) {
  const Calotte hole = calotte(0.8, 400);
  const Cap flat = triangulate_polygon(hole.rim, std::vector<Vec3>(hole.rim.size()), no_edge_is_taken);
  const std::size_t all = faired(hole.rim, flat, hole.beyond, no_edge_is_taken, 100000).inner.size();
  const std::size_t few = faired(hole.rim, flat, hole.beyond, no_edge_is_taken, 100).inner.size();
  EXPECT_GT(few, 0u);
  EXPECT_LT(2 * few, all);
}

}  // namespace
}  // namespace octafront::mend
