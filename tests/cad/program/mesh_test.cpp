// From CAD files to meshes, through all of the library and the program octafront-cad.

#include <octafront/domain.h>
#include <octafront/error.h>
#include <octafront/generate.h>
#include <octafront/validity.h>

#include "shapes.h"
#include "support/temporary_folder.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <set>

#include <gtest/gtest.h>

namespace octafront::testing {

namespace {

class CadMesh : public ::testing::Test {
 protected:
  void SetUp() override { setenv("OCTAFRONT_CAD", OCTAFRONT_CAD_PROGRAM, 1); }

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
  const testing::TemporaryFolder folder_;
};

TEST_F(CadMesh, VerticesOfASphereLieOnIt) {
  for (const int order : {1, 2}) {
    const Result made = meshed(opened("sphere", ".step"), order);
    EXPECT_FALSE(first_defect(made.mesh));
    EXPECT_NEAR(made.report.true_volume, 500 * M_PI / 3, 1e-6);
    EXPECT_NEAR(made.report.volume, made.report.true_volume, (order == 1 ? 5e-2 : 1e-3) * made.report.true_volume);
    for (const Triangle& t : made.mesh.boundary)
      for (const VertexIndex v : t) EXPECT_NEAR(length(made.mesh.points[v]), 5, 1e-9);
  }
}

bool has_note(const Report& report, const std::string& part) {
  for (const StageReport& stage : report.stages)
    for (const std::string& note : stage.notes)
      if (note.find(part) != std::string::npos) return true;
  return false;
}

TEST_F(CadMesh, WhatChordsCutOffIsSaidAndATolerancePays) {
  for (const std::string shape : {"sphere", "torus"}) {
    SCOPED_TRACE(shape);
    const Domain domain = opened(shape, ".step");
    const Result as_asked = meshed(domain);
    EXPECT_TRUE(has_note(as_asked.report, "of its volume in the CAD file"));
    // A size of the torus is no larger than a twelfth of a turn of its tube.
    const double most = shape == "torus" ? 4 : 1.6,
                 needed = as_asked.report.true_volume / (0.12 * kSize * kSize * kSize);
    EXPECT_LT(static_cast<double>(as_asked.mesh.tets.size()), most * needed);
    EXPECT_FALSE(has_note(meshed(domain, 2).report, "of its volume in the CAD file"));
    Options options;
    options.size.size = kSize;
    options.surface.volume_tolerance = 0.8;
    const Result within = generate(domain, options);
    EXPECT_NEAR(within.report.volume, within.report.true_volume, 0.008 * within.report.true_volume);
    EXPECT_FALSE(has_note(within.report, "of its volume in the CAD file"));
    EXPECT_GT(within.mesh.tets.size(), as_asked.mesh.tets.size());
  }
}

TEST_F(CadMesh, ANumberOfElementsIsMet) {
  const Domain domain = opened("torus", ".step");
  Options options;
  options.size.elements = 4000;
  const Result made = generate(domain, options);
  EXPECT_NEAR(static_cast<double>(made.mesh.tets.size()), 4000, 600);
}

TEST_F(CadMesh, AGivenSizeFollowsCurvatureDownToAQuarter) {
  // A rod of radius 3: 12 elements a turn are 1.57 long.
  Options options;
  options.size.size = 4;
  const SizeField fine = generate_sizes(opened("cylinder", ".step"), options).sizes;
  EXPECT_NEAR(fine.min_size(), M_PI / 2, 0.2);
  options.size.size = 20;
  options.size.min_size = 8;
  EXPECT_GE(generate_sizes(opened("cylinder", ".step"), options).sizes.min_size(), 7.9);
}

TEST_F(CadMesh, ASizeOfAnotherUnitIsSaid) {
  const std::string file = folder_ / "box.brep";
  write_shape(shape_named("box"), file);
  IntakeOptions metres;
  metres.cad.unit = "m", metres.cad.size = 0.5;
  try {
    open_domain(file, metres);
    FAIL();
  } catch (const OptionError& error) {
    EXPECT_NE(std::string(error.what()).find("is 50 times the part, which is 0.01 m long"), std::string::npos)
        << error.what();
  }
  metres.cad.size = 0.005;
  EXPECT_NO_THROW(open_domain(file, metres));
}

TEST_F(CadMesh, TinyPartsAreMeshedInTheirOwnUnit) {
  const std::string file = folder_ / "tiny.brep";
  write_shape(shape_named("tiny"), file);
  Options options;
  options.size.size = 1e-5;
  const Result made = generate(open_domain(file, intake_for(options)), options);
  const double volume = (100 * 50 - M_PI * 100) * 20 * 1e-18;
  EXPECT_NEAR(made.report.true_volume, volume, 1e-5 * volume);
  EXPECT_NEAR(made.report.volume, volume, 1e-2 * volume);
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

TEST_F(CadMesh, AWingHasItsVolumeHoweverManyKnotsItsSplinesHave) {
  const Result made = generate(opened("wing", ".step"));
  const double volume = volume_of_shape("wing");
  EXPECT_NEAR(made.report.true_volume, volume, 2e-3 * volume);
  EXPECT_NEAR(made.report.volume, volume, 5e-3 * volume);
  EXPECT_GT(made.report.quality.dihedral_min, 10);
}

TEST_F(CadMesh, ARodIsMeshedWithoutASize) {
  const std::string file = folder_ / "rod.step";
  write_shape(shape_named("rod"), file);
  const Result made = generate(open_domain(file));
  EXPECT_NEAR(made.report.true_volume, volume_of_shape("rod"), 1e-6);
  EXPECT_NEAR(made.report.volume, made.report.true_volume, 0.05 * made.report.true_volume);
  EXPECT_LT(made.mesh.tets.size(), 60'000u);
}

TEST_F(CadMesh, BothSidesOfAThinTubeStayApart) {
  const Result made = meshed(opened("thin tube", ".step"));
  EXPECT_TRUE(has_note(made.report, "their two sides would cross"));
  EXPECT_NEAR(made.report.volume, volume_of_shape("thin tube"), 0.02 * volume_of_shape("thin tube"));
  EXPECT_LT(made.mesh.tets.size(), 20'000u);
  EXPECT_GT(made.report.quality.dihedral_min, 0.2);
}

TEST_F(CadMesh, FacesArePatchesByTheirNames) {
  const Result made = meshed(opened("box", ".step"));
  const std::set<std::uint32_t> used(made.mesh.patch.begin(), made.mesh.patch.end());
  EXPECT_EQ(used.size(), 6u);
  for (const std::uint32_t p : used) EXPECT_EQ(made.mesh.patch_names[p].substr(0, 5), "face ");
}

}  // namespace

}  // namespace octafront::testing
