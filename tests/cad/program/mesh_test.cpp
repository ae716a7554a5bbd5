// From CAD files to meshes, through all of the library and the program octafront-cad.

#include <octafront/domain.h>
#include <octafront/error.h>
#include <octafront/generate.h>
#include <octafront/validity.h>

#include "shapes.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <set>

#include <gtest/gtest.h>

namespace octafront::testing {

namespace {

class CadMesh : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_);
    setenv("OCTAFRONT_CAD", OCTAFRONT_CAD_PROGRAM, 1);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  Domain opened(const std::string& shape, const std::string& ending, IntakeOptions options = {}) const {
    const std::string file = folder_ / (shape + ending);
    write_shape(shape_named(shape), file);
    options.cad.size = kSize;
    return open_domain(file, options);
  }

  static Result meshed(const Domain& domain, int order = 1) {
    Options options;
    options.size.size = kSize;
    options.order = order;
    return generate(domain, options);
  }

  static constexpr double kSize = 1.5;
  const std::filesystem::path folder_ =
      std::filesystem::path(::testing::TempDir()) / ::testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(CadMesh, VerticesOfASphereLieOnIt) {
  for (const int order : {1, 2}) {
    const Result made = meshed(opened("sphere", ".step"), order);
    EXPECT_FALSE(first_defect(made.mesh));
    EXPECT_NEAR(made.report.true_volume, 500 * M_PI / 3, 1e-6);
    EXPECT_NEAR(made.report.volume, made.report.true_volume, (order == 1 ? 1e-2 : 1e-3) * made.report.true_volume);
    for (const Triangle& t : made.mesh.boundary)
      for (const VertexIndex v : t) EXPECT_NEAR(length(made.mesh.points[v]), 5, 1e-9);
  }
}

TEST_F(CadMesh, SolidsThatTouchShareFacesAndKeepVolumes) {
  const Result made = meshed(opened("touching", ".brep"));
  EXPECT_FALSE(first_defect(made.mesh));
  ASSERT_EQ(made.report.regions.size(), 2u);
  EXPECT_EQ(made.report.regions[0].name, "solid 1");
  EXPECT_NEAR(made.report.regions[0].volume, 1000, 1e-6);
  EXPECT_NEAR(made.report.regions[1].volume, 125, 1e-6);
  double shared = 0;
  for (const Triangle& t : made.mesh.interfaces) {
    const Vec3 a = made.mesh.points[t[0]], b = made.mesh.points[t[1]], c = made.mesh.points[t[2]];
    shared += length(cross(b - a, c - a)) / 2;
  }
  EXPECT_NEAR(shared, 25, 1e-6);
}

TEST_F(CadMesh, OverlapIsRefusedUnlessSomebodyGetsIt) {
  EXPECT_THROW(opened("overlapping", ".step"), InputError);
  IntakeOptions options;
  options.complex.overlap = ComplexOptions::Overlap::kNew;
  const Result made = meshed(opened("overlapping", ".step", options));
  ASSERT_EQ(made.report.regions.size(), 3u);
  const double volumes[] = {950, 75, 50};
  for (int r = 0; r < 3; ++r) EXPECT_NEAR(made.report.regions[static_cast<std::size_t>(r)].volume, volumes[r], 1e-6);
}

TEST_F(CadMesh, ACavityStaysEmpty) {
  const Result made = meshed(opened("nested faces", ".igs"));
  double sum = 0;
  for (const RegionSummary& region : made.report.regions) sum += region.volume;
  EXPECT_NEAR(sum, 1000 - 216 + 8, 1e-6);
}

TEST_F(CadMesh, FacesArePatchesByTheirNames) {
  const Result made = meshed(opened("box", ".step"));
  const std::set<std::uint32_t> used(made.mesh.patch.begin(), made.mesh.patch.end());
  EXPECT_EQ(used.size(), 6u);
  for (const std::uint32_t p : used) EXPECT_EQ(made.mesh.patch_names[p].substr(0, 5), "face ");
}

}  // namespace

}  // namespace octafront::testing
