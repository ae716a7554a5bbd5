// Bodies and images that several processes mesh together: one mesh for any number of ranks and threads.

#include <octafront/domain.h>
#include <octafront/generate.h>
#include <octafront/image.h>
#include <octafront/validity.h>

#include "base/shared/virtual_ranks.h"
#include "support/named_surfaces.h"

#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

Options sized(double size) {
  Options options;
  options.size.size = size;
  return options;
}

/// `open` gives the domain on each rank, as the ranks of a program read the same files.
void expect_one_mesh(const std::function<Domain()>& open, const Options& options, std::size_t regions) {
  const Result alone = generate(open(), options);
  EXPECT_EQ(first_defect(alone.mesh), std::nullopt);
  EXPECT_EQ(alone.mesh.region_names.size(), regions);
  for (const int count : {1, 2, 3, 5, 8})
    for (const int threads : {1, 2})
      run_virtual_ranks(count, [&](Ranks& ranks) {
        RunContext context;
        context.ranks = &ranks;
        context.threads = threads;
        const Result made = generate(open(), options, context);
        EXPECT_EQ(made.mesh, alone.mesh) << count << " ranks, " << threads << " threads";
        EXPECT_EQ(ranks.use.bytes_taken > 10'000u, count > 1);
      });
}

/// A ball in two halves within a cube of voxels.
Image halves(std::uint32_t n) {
  Image image;
  image.grid.size = {n, n, n};
  const double middle = 0.5 * (n - 1), radius = 0.38 * n;
  std::vector<std::uint8_t> values;
  for (std::uint32_t k = 0; k < n; ++k)
    for (std::uint32_t j = 0; j < n; ++j)
      for (std::uint32_t i = 0; i < n; ++i) {
        const Vec3 p = Vec3{1. * i, 1. * j, 1. * k} - Vec3{middle, middle, middle};
        values.push_back(length(p) > radius ? 0 : p.x < 0 ? 1 : 2);
      }
  image.values = values;
  return image;
}

TEST(SharedDomain, AnImageOfLabels) {
  IntakeOptions intake;
  intake.image.regions.kind = ImageRegions::Kind::kLabels;
  expect_one_mesh([&] { return open_domain(halves(18), intake); }, sized(0.9), 2);
}

TEST(SharedDomain, AnImageOfGreyValues) {
  constexpr std::uint32_t n = 16;
  Image image;
  image.grid.size = {n, n, n};
  std::vector<float> values;
  for (std::uint32_t k = 0; k < n; ++k)
    for (std::uint32_t j = 0; j < n; ++j)
      for (std::uint32_t i = 0; i < n; ++i)
        values.push_back(static_cast<float>(6 - length(Vec3{i - 7.5, j - 7.5, k - 7.5})));
  image.values = values;
  IntakeOptions intake;
  intake.image.regions.bands = {{0, 2.5, "skin"}, {2.5, 1e9, "core"}};
  expect_one_mesh([&] { return open_domain(image, intake); }, sized(0.8), 2);
}

TEST(SharedDomain, BodiesThatTouch) {
  const std::vector<Body> bodies{{"left", testing::box(1, 1, 1)},
                                 {"right", testing::transformed(testing::box(1, 1, 1), 1, {1, 0.25, 0})}};
  expect_one_mesh([&] { return open_domain(bodies); }, sized(0.13), 2);
}

TEST(SharedDomain, ASurfaceThatIsKept) {
  Options options = sized(0.12);
  options.surface.keep = true;
  expect_one_mesh([] { return open_domain(Domain(testing::torus(60, 24))); }, options, 0);
}

}  // namespace
}  // namespace octafront
