#include "base/geometry/measures.h"
#include "soup/mend/caps.h"
#include "support/random.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace octafront::mend {
namespace {

constexpr Vec3 kUp{0, 0, 1};
constexpr std::uint32_t kCorners = 60;

/// A circle of radius 1 whose corners stray by up to `tooth`; counter-clockwise as seen from above.
std::vector<Vec3> torn_circle(double tooth) {
  testing::Random random(7);
  std::vector<Vec3> rim;
  for (std::uint32_t i = 0; i < kCorners; ++i) {
    const double angle = 2 * std::numbers::pi * i / kCorners, r = 1 + tooth * (2 * random.unit() - 1);
    rim.push_back({r * std::cos(angle), r * std::sin(angle), tooth * random.unit()});
  }
  return rim;
}

/// Every edge of the rim once, along it, and every other edge once either way.
void expect_closes(const Cap& cap, std::uint32_t corners) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  for (const auto& t : cap)
    for (std::size_t k = 0; k < 3; ++k) ++uses[{t[k], t[(k + 1) % 3]}];
  for (const auto& [edge, count] : uses) {
    EXPECT_EQ(count, 1);
    const bool on_rim = edge.first < corners && edge.second == (edge.first + 1) % corners;
    EXPECT_EQ(uses.count({edge.second, edge.first}), on_rim ? 0u : 1u);
  }
}

TEST(CapWithBase, ClosesTheRimByWallsAndAFlatBase) {
  for (const double tooth : {0.0, 0.02, 0.1}) {
    const std::vector<Vec3> rim = torn_circle(tooth);
    const FairCap made = cap_with_base(rim, kUp, rim);
    ASSERT_FALSE(made.triangles.empty());
    expect_closes(made.triangles, kCorners);
    const double top = std::ranges::max_element(rim, {}, &Vec3::z)->z;
    for (const Vec3 p : made.inner) {
      EXPECT_NEAR(p.z, made.inner.front().z, 1e-12);
      EXPECT_GT(p.z, top + kBaseThickness * 2);
    }
    const auto at = [&](std::uint32_t v) { return v < kCorners ? rim[v] : made.inner[v - kCorners]; };
    double base = 0;
    for (const auto& [a, b, c] : made.triangles)
      if (std::min({a, b, c}) >= kCorners) {
        EXPECT_GT(double_area_normal(at(a), at(b), at(c)).z, 0);  // nothing folds back
        base += triangle_area(at(a), at(b), at(c));
      }
    EXPECT_NEAR(base, std::numbers::pi, 0.1 + 2 * tooth);
  }
}

TEST(CapWithBase, StandsOffHillsOverIt) {
  std::vector<Vec3> around = torn_circle(0);
  const std::vector<Vec3> rim = around;
  around.push_back({0.2, -0.3, 0.5});
  around.push_back({3, 0, 0.9});  // beside it
  const FairCap made = cap_with_base(rim, kUp, around);
  ASSERT_FALSE(made.inner.empty());
  EXPECT_NEAR(made.inner.front().z, 0.5 + kBaseThickness * 2 * std::numbers::sqrt2, 1e-3);
}

TEST(CapWithBase, ThereIsNoneWhereItWouldCrossItselfOrStandTooHigh) {
  std::vector<Vec3> eight;
  for (int i = 0; i < 40; ++i) {
    const double t = 2 * std::numbers::pi * (i + 0.5) / 40;
    eight.push_back({std::sin(t), std::sin(t) * std::cos(t), 0.1 * std::cos(t)});
  }
  EXPECT_TRUE(cap_with_base(eight, kUp, eight).triangles.empty());
  const std::vector<Vec3> rim = torn_circle(0);
  EXPECT_TRUE(cap_with_base(rim, kUp, std::vector<Vec3>{{0, 0, 5}}).triangles.empty());
}

}  // namespace
}  // namespace octafront::mend
