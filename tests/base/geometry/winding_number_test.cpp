#include "base/geometry/winding_number.h"

#include "base/geometry/measures.h"
#include "support/named_surfaces.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace octafront {
namespace {

double by_all_triangles(const SurfaceMesh& s, Vec3 p) {
  double sum = 0;
  for (const auto& [a, b, c] : s.triangles) sum += solid_angle(p, s.points[a], s.points[b], s.points[c]);
  return sum / (4 * std::numbers::pi);
}

SurfaceMesh without_a_third(SurfaceMesh s) {
  std::vector<Triangle> kept;
  for (std::size_t t = 0; t < s.triangles.size(); ++t)
    if (t % 3 != 0) kept.push_back(s.triangles[t]);
  s.triangles = kept;
  return s;
}

TEST(WindingNumber, AgreesWithTheSumOfAllSolidAngles) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1.5, 1.5);
  for (const SurfaceMesh& s : {testing::icosphere(4), testing::torus(64, 32), without_a_third(testing::torus(64, 32)),
                               testing::joined(testing::icosphere(3), testing::cube(8))}) {
    const WindingNumber winding(s);
    for (int i = 0; i < 500; ++i) {
      const Vec3 p{unit(random), unit(random), unit(random)};
      EXPECT_NEAR(winding.at(p), by_all_triangles(s, p), 0.05);
    }
  }
}

TEST(WindingNumber, IsOneInsideAndCountsOverlaps) {
  const WindingNumber sphere(testing::icosphere(3));
  EXPECT_NEAR(sphere.at({0.1, 0.2, -0.1}), 1, 0.05);
  EXPECT_NEAR(sphere.at({3, 0, 0}), 0, 0.05);
  const WindingNumber two(testing::joined(testing::icosphere(3), testing::cube(4)));
  EXPECT_NEAR(two.at({0.3, 0.3, 0.3}), 2, 0.05);
  EXPECT_EQ(WindingNumber(SurfaceMesh{}).at({0, 0, 0}), 0);
}

}  // namespace
}  // namespace octafront
