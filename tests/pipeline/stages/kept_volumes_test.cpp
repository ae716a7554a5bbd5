// Regions have the volumes that they have in the input, or it is said by region what became of them and what helps.

#include "pipeline/stages/kept_volumes.h"

#include <octafront/generate.h>
#include <octafront/improve_existing.h>
#include <octafront/quality.h>
#include <octafront/validity.h>

#include "support/complexes.h"
#include "support/labelled_walls.h"
#include "support/named_surfaces.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

Options sized_to(double size, bool keep = false) {
  Options o;
  o.size.size = size;
  o.surface.keep_volumes = keep;
  return o;
}

std::vector<Finding> findings_called(const Report& report, const std::string& code) {
  std::vector<Finding> found;
  for (const StageReport& stage : report.stages)
    for (const Finding& f : stage.findings)
      if (f.code == code) found.push_back(f);
  return found;
}

double told_value(const Finding& finding, const std::string& key) {
  for (const auto& [name, value] : finding.values)
    if (name == key) return value;
  return NAN;
}

/// A ball of its own region in the middle of a cube.
SurfaceMesh ball_in_cube(double radius) {
  SurfaceMesh all = testing::box(1, 1, 1, 2);
  all.patch.clear(), all.patch_names.clear();
  all.sides.assign(all.triangles.size(), {kNone, 0});
  const SurfaceMesh ball = testing::transformed(testing::icosphere(3, radius), 1, {0.5, 0.52, 0.47});
  const auto first = static_cast<VertexIndex>(all.points.size());
  all.points.insert(all.points.end(), ball.points.begin(), ball.points.end());
  for (const auto& [a, b, c] : ball.triangles) {
    all.triangles.push_back({first + a, first + b, first + c});
    all.sides.push_back({0, 1});
  }
  all.region_names = {"cube", "ball"};
  return all;
}

void expect_kept(const Result& made, double part) {
  EXPECT_EQ(first_defect(made.mesh), std::nullopt);
  for (const VolumeChange& change : volume_changes(made.report))
    EXPECT_NEAR(change.part(), 0, part) << change.region << " of " << change.before;
}

TEST(KeptVolumes, ARoundBodyKeepsItsVolumeAtAnySize) {
  for (const double size : {0.25, 0.4, 0.6}) {
    SCOPED_TRACE(size);
    expect_kept(generate(testing::icosphere(4), sized_to(size, true)), 2e-4);
    expect_kept(generate(testing::torus(96, 48), sized_to(size / 2, true)), 2e-3);
  }
}

TEST(KeptVolumes, ScaleAndPlaceDoNotMatter) {
  for (const double scale : {1e-3, 1.0, 1e6}) {
    SCOPED_TRACE(scale);
    const SurfaceMesh ball = testing::transformed(testing::icosphere(4), scale, Vec3{7, -3, 20} * scale);
    expect_kept(generate(ball, sized_to(0.4 * scale, true)), 2e-4);
  }
}

TEST(KeptVolumes, VoxelBodiesKeepTheirOutsideToo) {
  Domain domain;
  domain.surface = testing::icosphere(5, 15);
  domain.voxel_spacing = 1;
  for (const double size : {2.0, 3.0, 5.0}) {
    SCOPED_TRACE(size);
    expect_kept(generate(domain, sized_to(size)), 2e-3);
  }
}

TEST(KeptVolumes, FlatFacesStayFlat) {
  const SurfaceMesh box = testing::box(1, 2, 3, 3);
  const Result made = generate(box, sized_to(0.4, true));
  expect_kept(made, 1e-12);
  EXPECT_EQ(bounding_box(made.mesh.points).lo, bounding_box(box.points).lo);
  EXPECT_EQ(bounding_box(made.mesh.points).hi, bounding_box(box.points).hi);
}

TEST(KeptVolumes, RegionsOfAComplexKeepTheirs) {
  const testing::KnownComplex shells = testing::nested_shells(3);
  expect_kept(generate(shells.surface, sized_to(0.25, true)), 1e-2);
  expect_kept(generate(ball_in_cube(0.2), sized_to(0.15, true)), 5e-3);
}

TEST(KeptVolumes, ElementsAreNotSpoiltForIt) {
  const Result freely = generate(testing::icosphere(4), sized_to(0.4)),
               kept = generate(testing::icosphere(4), sized_to(0.4, true));
  EXPECT_GT(kept.report.quality.beta_min, std::min(0.3, 0.9 * freely.report.quality.beta_min));
  EXPECT_GT(kept.report.quality.dihedral_min, 15);
}

TEST(LostVolumes, AreSaidByRegion) {
  const Result made = generate(ball_in_cube(0.1), sized_to(0.25));
  const std::vector<Finding> lost = findings_called(made.report, "volume-lost");
  ASSERT_EQ(lost.size(), 1u);
  EXPECT_EQ(lost[0].region, "ball");
  ASSERT_EQ(made.report.regions.size(), 2u);
  const RegionSummary& ball = made.report.regions[1];
  EXPECT_NEAR(ball.input_volume, 4.0 / 3 * 3.14159 * 1e-3, 1e-4);
  EXPECT_NEAR(told_value(lost[0], "change_percent"), 100 * (ball.volume / ball.input_volume - 1), 1e-9);
  EXPECT_LT(told_value(lost[0], "change_percent"), -1);
  EXPECT_NE(lost[0].text.find("`size_of` ball="), std::string::npos);
}

TEST(LostVolumes, StayAtTheSizeThatIsNamed) {
  Options options = sized_to(0.25);
  const auto lost = findings_called(generate(ball_in_cube(0.1), options).report, "volume-lost");
  ASSERT_EQ(lost.size(), 1u);
  options.size.named = {{"ball", told_value(lost[0], "size_that_keeps")}};
  const Result made = generate(ball_in_cube(0.1), options);
  EXPECT_TRUE(findings_called(made.report, "volume-lost").empty());
}

TEST(LostVolumes, OfASingleBodyAreSaidOnce) {
  const Result made = generate(testing::icosphere(4), sized_to(0.6));
  EXPECT_EQ(findings_called(made.report, "volume-lost").size(), 1u);
  EXPECT_TRUE(findings_called(generate(testing::icosphere(4), sized_to(0.1)).report, "volume-lost").empty());
}

TEST(LostVolumes, BodiesApartAreNotTakenForAllThereIs) {
  Options options = sized_to(0.3);
  options.require.volume = 1;
  const Result made =
      generate(testing::joined(testing::cube(1), testing::transformed(testing::cube(1), 2, {3, 0, 0})), options);
  EXPECT_EQ(made.report.regions.size(), 2u);
  EXPECT_TRUE(findings_called(made.report, "volume-lost").empty());
}

/// All of a hundred are in the report, ten are told one by one.
TEST(LostVolumes, OfManyRegionsAreSummedUp) {
  const testing::KnownComplex spheres = testing::packed_spheres(3, 1);
  const Result made = generate(spheres.surface, sized_to(0.4));
  EXPECT_EQ(findings_called(made.report, "volume-lost").size(), 10u);
  const auto more = findings_called(made.report, "volumes-changed");
  ASSERT_EQ(more.size(), 1u);
  std::size_t off = 0;
  for (const VolumeChange& change : volume_changes(made.report)) off += std::abs(change.part()) > 0.01;
  EXPECT_EQ(told_value(more[0], "regions"), static_cast<double>(off - 10));
}

TEST(LostVolumes, LayersBelongToTheirRegion) {
  Options options = sized_to(0.3);
  options.layers.count = 2, options.layers.total = 0.05;
  const Result made = generate(testing::cube(3), options);
  expect_kept(made, 1e-9);
  EXPECT_TRUE(findings_called(made.report, "volume-lost").empty());
}

TEST(LeastElement, IsTheOneOfTheMeshThatIsHandedOut) {
  Options options = sized_to(0.3);
  options.layers.count = 3, options.layers.total = 0.1;
  SurfaceMesh wedge = testing::unit_tetrahedron();
  for (Vec3& p : wedge.points) p.z *= 0.12;
  for (const int order : {1, 2}) {
    options.order = order;
    const Result made = generate(wedge, options);
    const QualitySummary q = summarize_quality(made.mesh);
    EXPECT_EQ(made.report.quality.beta_min, q.beta_min);
    EXPECT_EQ(made.report.quality.dihedral_min, q.dihedral_min);
    const auto poor = findings_called(made.report, "poor-elements");
    ASSERT_EQ(poor.size(), q.beta_min < 0.2 || q.dihedral_min < 10 ? 1u : 0u);
    ASSERT_FALSE(poor.empty()) << "the wedge is sharp";
    EXPECT_EQ(told_value(poor[0], "beta_min"), q.beta_min);
    EXPECT_EQ(told_value(poor[0], "dihedral_min_degrees"), q.dihedral_min);
    ASSERT_TRUE(poor[0].at.has_value());
    EXPECT_EQ(*poor[0].at, q.dihedral_min_at);
  }
}

}  // namespace
}  // namespace octafront
