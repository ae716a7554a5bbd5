// A mesh that is not what was required is not handed out, and the error says what it is like.

#include <octafront/adapt.h>
#include <octafront/error.h>
#include <octafront/generate.h>
#include <octafront/improve_existing.h>
#include <octafront/requirement_error.h>

#include "support/labelled_walls.h"
#include "support/named_surfaces.h"

#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

Options requiring_size(double size) {
  Options o;
  o.size.size = size;
  return o;
}

RequireOptions required(std::optional<double> volume, std::optional<double> angle, std::optional<double> size) {
  RequireOptions o;
  o.volume = volume, o.angle = angle, o.size = size;
  return o;
}

/// The findings with which work() fails.
template <class Work>
std::vector<Finding> missed_by(const Work& work) {
  try {
    work();
  } catch (const RequirementError& error) {
    EXPECT_GT(error.report.tets, 0u);
    for (const Finding& finding : error.report.stages.back().findings)
      EXPECT_NE(std::string(error.what()).find(finding.text), std::string::npos);
    return error.report.stages.back().findings;
  }
  return {};
}

double missed_value(const Finding& finding, const std::string& key) {
  for (const auto& [name, value] : finding.values)
    if (name == key) return value;
  return -1;
}

TEST(Requirements, TheVolumeOfEachRegionIsLookedAt) {
  Options options = requiring_size(0.5);
  const double change =
      generate(testing::icosphere(4), options).report.volume / enclosed_volume(testing::icosphere(4)) - 1;
  options.require.volume = -100 * change + 0.01;
  EXPECT_TRUE(missed_by([&] { generate(testing::icosphere(4), options); }).empty());
  options.require.volume = -100 * change - 0.01;
  const auto missed = missed_by([&] { generate(testing::icosphere(4), options); });
  ASSERT_EQ(missed.size(), 1u);
  EXPECT_EQ(missed[0].code, "require-volume");
  EXPECT_NEAR(missed_value(missed[0], "change_percent"), 100 * change, 1e-9);
}

TEST(Requirements, TheLeastAngleOfAllElementsIsLookedAt) {
  SurfaceMesh wedge = testing::unit_tetrahedron();
  for (Vec3& p : wedge.points) p.z *= 0.12;
  Options options = requiring_size(0.3);
  const double least = generate(wedge, options).report.quality.dihedral_min;
  options.require.angle = least;
  EXPECT_TRUE(missed_by([&] { generate(wedge, options); }).empty());
  options.require.angle = least + 1;
  const auto missed = missed_by([&] { generate(wedge, options); });
  ASSERT_EQ(missed.size(), 1u);
  EXPECT_EQ(missed[0].code, "require-angle");
  EXPECT_EQ(missed_value(missed[0], "dihedral_min_degrees"), least);
  EXPECT_GE(missed_value(missed[0], "elements"), 1);
  EXPECT_TRUE(missed[0].at.has_value());
}

TEST(Requirements, EachEdgeIsMeasuredByTheSizeThere) {
  Options options = requiring_size(0.25);
  const Result made = generate(testing::cube(), options);
  double longest = 0;
  for (const Tet& tet : made.mesh.tets)
    for (const auto& [i, j] : kTetEdges)
      longest = std::max(longest, distance(made.mesh.points[tet[i]], made.mesh.points[tet[j]]) / 0.25);
  options.require.size = longest + 1e-6;
  EXPECT_TRUE(missed_by([&] { generate(testing::cube(), options); }).empty());
  options.require.size = longest - 1e-6;
  const auto missed = missed_by([&] { generate(testing::cube(), options); });
  ASSERT_EQ(missed.size(), 1u);
  EXPECT_EQ(missed[0].code, "require-size");
  EXPECT_NEAR(missed_value(missed[0], "longest_ratio"), longest, 1e-9);
}

TEST(Requirements, AllThatIsMissedIsSaid) {
  Options options = requiring_size(0.5);
  options.require = required(0.001, 65, 1);
  EXPECT_EQ(missed_by([&] { generate(testing::icosphere(4), options); }).size(), 3u);
}

TEST(Requirements, HoldForMeshesThatAreImprovedOrAdapted) {
  const TetMesh ball = generate(testing::icosphere(3), requiring_size(0.4)).mesh;
  Options improving;
  improving.require.angle = 65;
  EXPECT_EQ(missed_by([&] { improve_existing(ball, improving); }).size(), 1u);
  improving.require.angle.reset();
  improving.require.volume = 1e-6;
  EXPECT_TRUE(missed_by([&] { improve_existing(ball, improving); }).empty());
  improving.require.size = 2;
  EXPECT_THROW(improve_existing(ball, improving), OptionError);
  Options adapting = requiring_size(0.3);
  adapting.require = required({}, 65, 1);
  EXPECT_EQ(missed_by([&] { adapt_existing(ball, adapting); }).size(), 2u);
  adapting.require = required({}, 1, 10);
  EXPECT_TRUE(missed_by([&] { adapt_existing(ball, adapting); }).empty());
}

TEST(Requirements, OutOfRangeAreRefusedBeforeAnyWork) {
  for (const RequireOptions& wrong :
       {required(-1, {}, {}), required({}, 0, {}), required({}, 71, {}), required({}, {}, 0.9)}) {
    Options options;
    options.require = wrong;
    EXPECT_THROW(check_options(options), OptionError);
  }
}

}  // namespace
}  // namespace octafront
