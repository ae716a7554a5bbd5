// Needles, rods and rings: sound elements, in proportion, that keep the volume.

#include <octafront/generate.h>
#include <octafront/validity.h>

#include "support/faceted.h"
#include "support/named_surfaces.h"
#include "support/thin_surfaces.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace octafront {
namespace {

Options thin_of_size(double size) {
  Options options;
  options.size.size = size;
  return options;
}

double volume_change_of(const Report& report) {
  return report.volume / report.input_volume - 1;
}

bool says(const Report& report, const std::string& words) {
  for (const StageReport& stage : report.stages)
    for (const std::string& note : stage.notes)
      if (note.find(words) != std::string::npos) return true;
  return false;
}

TEST(ThinBodies, AutomaticSizesAreInProportionHoweverSlender) {
  for (const double radius : {0.1, 0.05, 0.01}) {
    SCOPED_TRACE(radius);
    const Result r = generate(Domain(testing::rod(24, radius, 4)));
    EXPECT_EQ(first_defect(r.mesh), std::nullopt);
    EXPECT_LT(std::abs(volume_change_of(r.report)), 0.01);
    EXPECT_GT(r.report.quality.dihedral_min, 20);
    EXPECT_LT(r.report.tets, 60'000u);
    EXPECT_GT(r.report.tets, 10'000u);
  }
}

TEST(ThinBodies, CoarseAutomaticSizesMakeThemAnew) {
  for (const double factor : {2.5, 4.0}) {
    SCOPED_TRACE(factor);
    Options options;
    options.size.automatic_factor = factor;
    const Result r = generate(Domain(testing::rod(24, 0.05, 4)), options);
    EXPECT_LT(std::abs(volume_change_of(r.report)), 0.01);
    EXPECT_GT(r.report.quality.dihedral_min, 20);
    EXPECT_LT(r.report.tets, 10'000u);
  }
  const Result needle = generate(Domain(testing::needle(24, 0.05, 4)));
  EXPECT_LT(std::abs(volume_change_of(needle.report)), 0.01);
  EXPECT_GT(needle.report.quality.beta_mean, 0.85);
  EXPECT_LT(needle.report.tets, 80'000u);
}

TEST(ThinBodies, AGivenSizeDoesNotLoseThem) {
  for (const double size : {0.1, 0.2, 0.5}) {
    SCOPED_TRACE(size);
    const Result r = generate(Domain(testing::rod(24, 0.05, 4)), thin_of_size(size));
    EXPECT_LT(std::abs(volume_change_of(r.report)), 0.05);
    EXPECT_GT(r.report.quality.dihedral_min, 20);
    EXPECT_LT(r.report.tets, 20'000u);
    EXPECT_TRUE(says(r.report, "round and thinner"));
  }
  const Result ring = generate(Domain(testing::torus(96, 12, 1, 0.02)), thin_of_size(0.1));
  EXPECT_LT(std::abs(volume_change_of(ring.report)), 0.05);
  EXPECT_GT(ring.report.quality.dihedral_min, 20);
}

TEST(ThinBodies, ANeedleKeepsItsVolumeAndItsElementsAreNotFlat) {
  const Result r = generate(Domain(testing::needle(24, 0.05, 4)), thin_of_size(0.2));
  EXPECT_EQ(first_defect(r.mesh), std::nullopt);
  EXPECT_LT(std::abs(volume_change_of(r.report)), 0.05);
  EXPECT_GT(r.report.quality.dihedral_min, 3);  // at its tip
  EXPECT_LT(r.report.tets, 40'000u);
}

TEST(ThinBodies, AHoleMuchNarrowerThanElementsKeepsItsCornersAndVolume) {
  for (const double scale : {1e-3, 1.0, 1e6})
    for (const double size : {0.1, 0.2, 0.3}) {
      SCOPED_TRACE(::testing::Message() << size << ' ' << scale);
      const SurfaceMesh plate = testing::transformed(testing::faceted_ring(4, 7e-4, 1, 0.1), scale, {});
      const Result r = generate(Domain(plate), thin_of_size(size * scale));
      EXPECT_LT(std::abs(volume_change_of(r.report)), 5e-6);
      EXPECT_GT(r.report.quality.dihedral_min, 0.4);
      EXPECT_LT(r.report.tets, 10'000u);
    }
}

TEST(ThinBodies, WhatIsThickHasTheSizeThatWasGiven) {
  const Result r = generate(Domain(testing::icosphere(3)), thin_of_size(0.3));
  EXPECT_FALSE(says(r.report, "round and thinner"));
}

}  // namespace
}  // namespace octafront
