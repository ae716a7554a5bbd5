#include <octafront/generate.h>
#include <octafront/validity.h>

#include "support/named_surfaces.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace octafront {
namespace {

bool was_coarsened(const Result& r) {
  return std::ranges::any_of(r.report.stages, [](const StageReport& s) { return s.name == "coarsen"; });
}

/// 120,000 triangles, a twentieth as long as the size.
SurfaceMesh fine_cube() {
  return testing::cube(100);
}

Options coarse_sizes() {
  Options o;
  o.size.size = 0.2;
  return o;
}

TEST(CoarseInput, FlatSidesStayFlatWithTheirPatches) {
  const SurfaceMesh cube = fine_cube();
  const Result r = generate(cube, coarse_sizes());
  EXPECT_TRUE(was_coarsened(r));
  EXPECT_EQ(first_defect(r.mesh), std::nullopt);
  EXPECT_NEAR(r.report.volume, 1, 1e-12);
  std::array<double, 6> area{};
  for (std::size_t t = 0; t < r.mesh.boundary.size(); ++t) {
    const auto [a, b, c] = r.mesh.boundary[t];
    ASSERT_LT(r.mesh.source[t], cube.triangles.size());
    EXPECT_EQ(cube.patch_of(r.mesh.source[t]), r.mesh.patch[t]);
    area.at(r.mesh.patch[t]) +=
        length(cross(r.mesh.points[b] - r.mesh.points[a], r.mesh.points[c] - r.mesh.points[a])) / 2;
  }
  for (const double a : area) EXPECT_NEAR(a, 1, 1e-12);
}

TEST(CoarseInput, IsTheSameOnAnyNumberOfThreads) {
  const SurfaceMesh sphere = testing::icosphere(7);
  RunContext alone, four;
  alone.threads = 1, four.threads = 4;
  const Result r = generate(sphere, coarse_sizes(), alone);
  EXPECT_TRUE(was_coarsened(r));
  EXPECT_EQ(r.report.hash, generate(sphere, coarse_sizes(), four).report.hash);
  EXPECT_NEAR(r.report.volume / enclosed_volume(sphere), 1, 0.02);
  for (const Triangle& t : r.mesh.boundary)
    for (const VertexIndex v : t) EXPECT_NEAR(length(r.mesh.points[v]), 1, 1.5e-3);
}

TEST(CoarseInput, StaysWhereItIsLookedAtClosely) {
  const auto is_coarsened_with = [](const auto& change) {
    Options o = coarse_sizes();
    change(o);
    return was_coarsened(generate(fine_cube(), o));
  };
  EXPECT_FALSE(is_coarsened_with([](Options& o) { o.surface.max_deviation = 0.01; }));
  EXPECT_FALSE(is_coarsened_with([](Options& o) { o.size.curvature = 12; }));
  EXPECT_FALSE(is_coarsened_with([](Options& o) { o.order = 2; }));
  EXPECT_FALSE(is_coarsened_with([](Options& o) { o.size.size = 0.05; }));
  EXPECT_FALSE(was_coarsened(generate(testing::cube(60), coarse_sizes())));
}

TEST(CoarseInput, ThinWallsStayAsTheyAre) {
  const Result r = generate(testing::box(1, 1, 1e-3, 100), coarse_sizes());
  const auto coarsen = std::ranges::find(r.report.stages, "coarsen", &StageReport::name);
  ASSERT_NE(coarsen, r.report.stages.end());
  EXPECT_EQ(coarsen->notes.size(), 1u);
  EXPECT_EQ(first_defect(r.mesh), std::nullopt);
  EXPECT_NEAR(r.report.volume, 1e-3, 1e-12);
}

}  // namespace
}  // namespace octafront
