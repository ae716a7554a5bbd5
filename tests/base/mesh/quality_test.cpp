#include <octafront/quality.h>
#include <octafront/validity.h>

#include "base/mesh/quality_sum.h"
#include "support/lattice_points.h"

#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

namespace octafront {
namespace {

constexpr Vec3 kUnit[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

// Coordinates k / 64 up to 1: coincidences and flat shapes occur.
Vec3 random_point() {
  return testing::lattice_point(64, 1.0 / 64);
}

RC_GTEST_PROP(RadiusRatio, ChangesSignUnderOddPermutationsAndNotWithScale, ()) {
  const Vec3 a = random_point(), b = random_point(), c = random_point(), d = random_point();
  const double beta = radius_ratio(a, b, c, d);
  RC_ASSERT(std::abs(radius_ratio(b, a, c, d) + beta) < 1e-12);
  RC_ASSERT(std::abs(radius_ratio(b, c, a, d) - beta) < 1e-12);
  for (const double s : {0x1p-400, 0x1p400}) RC_ASSERT(radius_ratio(a * s, b * s, c * s, d * s) == beta);
  RC_ASSERT(radius_ratio(a * 0x1p400, b * 0x1p400, c * 0x1p400) == radius_ratio(a, b, c));
}

TEST(RadiusRatio, OfANeedleKeepsItsDigits) {
  // An equilateral base of side h and a tip at height 1: beta tends to 6 r with r = h / (2 sqrt 3).
  const double h = 1e-7;
  const double beta =
      radius_ratio({0, 0, 0}, {h, 0, 0}, {h / 2, h * std::sqrt(0.75), 0}, {h / 2, h / std::sqrt(12), 1});
  EXPECT_NEAR(beta / (std::sqrt(3) * h), 1, 1e-6);
}

TEST(DihedralAngles, OfTheUnitTetrahedron) {
  const auto angles = dihedral_angles(kUnit[0], kUnit[1], kUnit[2], kUnit[3]);
  const double slanted = 54.735610317245346;
  for (int e = 0; e < 6; ++e) EXPECT_NEAR(angles[e], e < 3 ? 90 : slanted, 1e-12);
}

TEST(DihedralAngles, OfASliverApproachZeroAndStraight) {
  const double z = 1e-9;
  auto angles = dihedral_angles({0, 0, 0}, {1, 1, 0}, {1, 0, z}, {0, 1, z});
  std::sort(angles.begin(), angles.end());
  EXPECT_GT(angles[0], 0);
  EXPECT_LT(angles[0], 1e-6);
  EXPECT_GT(angles[5], 180 - 1e-6);
}

TEST(SummarizeQuality, OfNothingIsZero) {
  const QualitySummary s = summarize_quality({});
  EXPECT_EQ(s.elements, 0u);
  EXPECT_EQ(s.beta_min_tet, kNone);
}

TEST(SummarizeQuality, CountsEveryElementOnce) {
  TetMesh mesh;
  mesh.points.assign(kUnit, kUnit + 4);
  mesh.points.push_back({0.1, 0.1, 0.001});
  mesh.tets.assign(20000, {0, 1, 2, 3});
  mesh.tets[12345] = {0, 1, 2, 4};
  const QualitySummary s = summarize_quality(mesh);
  EXPECT_EQ(s.elements, 20000u);
  EXPECT_EQ(std::accumulate(s.beta_classes.begin(), s.beta_classes.end(), std::uint64_t{0}), 20000u);
  EXPECT_EQ(std::accumulate(s.dihedral_histogram.begin(), s.dihedral_histogram.end(), std::uint64_t{0}), 120000u);
  EXPECT_EQ(s.beta_classes[0], 1u);
  EXPECT_EQ(s.beta_min_tet, 12345u);
  EXPECT_EQ(s.dihedral_min_tet, 12345u);
  const Vec3 middle = (mesh.points[0] + mesh.points[1] + mesh.points[2] + mesh.points[4]) / 4;
  EXPECT_EQ(s.beta_min_at, middle);
  EXPECT_EQ(s.dihedral_min_at, middle);
  EXPECT_EQ(s.beta_min, radius_ratio(mesh.points[0], mesh.points[1], mesh.points[2], mesh.points[4]));
  const double sum = 19999 * radius_ratio(kUnit[0], kUnit[1], kUnit[2], kUnit[3]) + s.beta_min;
  EXPECT_NEAR(s.beta_mean, sum / 20000, QualitySum::kBetaUnit);
  EXPECT_GT(s.dihedral_max, 170);
}

TEST(SummarizeQuality, FindsTheAnglesOfEachElement) {
  std::uint64_t state = 1;
  const auto random = [&state] {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(state >> 40) / (1 << 24);
  };
  TetMesh mesh;
  std::array<std::uint64_t, 18> histogram{};
  double least = 180, most = 0;
  for (std::uint32_t t = 0; t < 2000; ++t) {
    for (int i = 0; i < 4; ++i) mesh.points.push_back({random(), random(), random() * (t % 3 == 0 ? 1e-9 : 1)});
    mesh.tets.push_back({4 * t, 4 * t + 1, 4 * t + 2, 4 * t + 3});
    const Vec3* const p = &mesh.points[4 * t];
    for (const double angle : dihedral_angles(p[0], p[1], p[2], p[3])) {
      least = std::min(least, angle);
      most = std::max(most, angle);
      ++histogram[static_cast<std::size_t>(std::clamp(static_cast<int>(angle / 10), 0, 17))];
    }
  }
  const QualitySummary s = summarize_quality(mesh);
  EXPECT_EQ(s.dihedral_histogram, histogram);
  EXPECT_DOUBLE_EQ(s.dihedral_min, least);
  EXPECT_DOUBLE_EQ(s.dihedral_max, most);
}

TEST(SummarizeQuality, OfAFlatElementSpansAllAngles) {
  TetMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.tets = {{0, 1, 2, 3}};
  const QualitySummary s = summarize_quality(mesh);
  EXPECT_EQ(s.dihedral_min, 0);
  EXPECT_EQ(s.dihedral_max, 180);
}

TetMesh regular_wedge() {
  TetMesh mesh;
  const double h = std::sqrt(0.75);
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0.5, h, 0}, {0, 0, 2}, {1, 0, 2}, {0.5, h, 2}};
  mesh.wide_cells = {{0, 3, {0, 1, 2, 3, 4, 5}}};
  return mesh;
}

TEST(WideCells, ScaledJacobianIsOneWhereTheyAreRegular) {
  const WideSummary wedge = summarize_wedges(regular_wedge());
  EXPECT_EQ(wedge.count, 1u);
  EXPECT_NEAR(wedge.least_scaled_jacobian, 1, 1e-12);
  EXPECT_EQ(wedge.turned + wedge.torn, 0u);
  TetMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, std::sqrt(0.5)}};
  mesh.wide_cells = {{0, 2, {0, 1, 2, 3, 4, kNone}}};
  EXPECT_NEAR(summarize_pyramids(mesh).least_scaled_jacobian, 1, 1e-12);
  EXPECT_EQ(summarize_wedges(mesh).count, 0u);
  EXPECT_EQ(first_wide_defect(mesh), std::nullopt);
}

TEST(WideCells, TurnedAndTornOnesAreTold) {
  TetMesh mesh = regular_wedge();
  mesh.wide_cells = {{0, 3, {0, 1, 2, 3, 4, 5}}, {3, 3, {0, 2, 1, 3, 5, 4}}, {6, 3, {0, 1, 2, 3, 5, 4}}};
  const WideSummary found = summarize_wedges(mesh);
  EXPECT_EQ(found.count, 3u);
  EXPECT_EQ(found.turned, 1u);
  EXPECT_EQ(found.torn, 1u);
  EXPECT_EQ(found.first_bad, 1u);
  EXPECT_LT(found.least_scaled_jacobian, 0);
  const auto defect = first_wide_defect(mesh);
  ASSERT_TRUE(defect);
  EXPECT_NE(defect->find("tetrahedra 3 to 5"), std::string::npos);
  EXPECT_NE(defect->find("turned"), std::string::npos);
}

}  // namespace
}  // namespace octafront
