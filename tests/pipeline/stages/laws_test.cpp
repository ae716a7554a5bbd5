// The same shape in other clothes, and the same run again: what must not change, does not.

#include <octafront/generate.h>
#include <octafront/validity.h>

#include "support/named_surfaces.h"

#include <gtest/gtest.h>

namespace octafront {
namespace {

Options of_size(double h) {
  Options o;
  o.size.size = h;
  return o;
}

TEST(Laws, SameInputSameMesh) {
  for (const SurfaceMesh& s : {testing::torus(40, 20), testing::cube(3)}) {
    const Result first = generate(s, of_size(0.15));
    for (const int threads : {1, 2, 3, 8}) {
      RunContext context;
      context.threads = threads;
      const Result again = generate(s, of_size(0.15), context);
      EXPECT_EQ(again.report.hash, first.report.hash) << threads << " threads";
      EXPECT_EQ(again.mesh, first.mesh);
    }
  }
}

TEST(Laws, ScaleAndShiftChangeNothingEssential) {
  const SurfaceMesh s = testing::torus(40, 20);
  const Result plain = generate(s, of_size(0.2));
  const struct {
    double scale;
    Vec3 shift;
  } kClothes[] = {{1e-6, {0, 0, 0}}, {1e6, {0, 0, 0}}, {1, {1e4, -2e4, 3e4}}, {1e3, {-1e6, 0, 5e5}}};
  for (const auto& [scale, shift] : kClothes) {
    SCOPED_TRACE(scale);
    const Result r = generate(testing::transformed(s, scale, shift), of_size(0.2 * scale));
    EXPECT_EQ(first_defect(r.mesh), std::nullopt);
    EXPECT_NEAR(static_cast<double>(r.mesh.tets.size()) / static_cast<double>(plain.mesh.tets.size()), 1, 0.05);
    EXPECT_NEAR(r.report.quality.beta_mean, plain.report.quality.beta_mean, 0.02);
    EXPECT_NEAR(r.report.volume / (plain.report.volume * scale * scale * scale), 1, 1e-3);
  }
}

TEST(Laws, OrderOfTheInputChangesNothingEssential) {
  const SurfaceMesh s = testing::torus(40, 20);
  const Result plain = generate(s, of_size(0.2));
  for (unsigned seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE(seed);
    const Result r = generate(testing::permuted(s, seed), of_size(0.2));
    EXPECT_EQ(first_defect(r.mesh), std::nullopt);
    EXPECT_NEAR(static_cast<double>(r.mesh.tets.size()) / static_cast<double>(plain.mesh.tets.size()), 1, 0.05);
    EXPECT_NEAR(r.report.quality.beta_mean, plain.report.quality.beta_mean, 0.02);
  }
}

TEST(Laws, RepairedClothesChangeNothingEssential) {
  const SurfaceMesh s = testing::torus(40, 20);
  const Result plain = generate(s, of_size(0.2));
  SurfaceMesh soup;
  for (const Triangle& t : s.triangles) {
    const auto first = static_cast<VertexIndex>(soup.points.size());
    for (const VertexIndex v : t) soup.points.push_back(s.points[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  for (std::size_t t = 0; t < soup.triangles.size(); t += 3) std::swap(soup.triangles[t][0], soup.triangles[t][1]);
  const Result r = generate(testing::reversed(soup), of_size(0.2));
  EXPECT_EQ(first_defect(r.mesh), std::nullopt);
  EXPECT_NEAR(static_cast<double>(r.mesh.tets.size()) / static_cast<double>(plain.mesh.tets.size()), 1, 0.05);
}

}  // namespace
}  // namespace octafront
