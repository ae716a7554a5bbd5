// A result is the body that went in: thin plates and shells keep their volume, and what does not is not handed out.

#include "pipeline/stages/kept_shape.h"

#include <octafront/error.h>
#include <octafront/generate.h>
#include <octafront/validity.h>

#include "support/named_surfaces.h"

#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

double change_of(const Report& report) {
  return report.volume / report.input_volume - 1;
}

/// Turned by some angles: coordinates of real parts are no round numbers.
SurfaceMesh turned_by_angles(SurfaceMesh surface) {
  const double c = std::cos(0.7), s = std::sin(0.7);
  for (Vec3& p : surface.points)
    p = {c * p.x - s * p.y, 0.6 * (s * p.x + c * p.y) - 0.8 * p.z, 0.8 * (s * p.x + c * p.y) + 0.6 * p.z};
  surface.patch.clear();
  surface.patch_names.clear();
  return surface;
}

TEST(KeptShape, PlatesKeepTheirVolumeHoweverThin) {
  for (const auto& [thick, squares] : {std::pair{1e-3, 1}, {1e-4, 1}, {1e-5, 10}, {1e-6, 1}, {1e-9, 1}}) {
    SCOPED_TRACE(::testing::Message() << thick << ", " << squares << " squares a side");
    const Result r = generate(turned_by_angles(testing::box(1, 1, thick, squares)));
    EXPECT_EQ(first_defect(r.mesh), std::nullopt);
    EXPECT_LT(std::abs(change_of(r.report)), 1e-4);
    EXPECT_LT(r.report.tets, 50'000u);
  }
}

TEST(KeptShape, PlatesKeepTheirVolumeAtAnySize) {
  for (const double size : {0.3, 0.05}) {
    SCOPED_TRACE(size);
    Options options;
    options.size.size = size;
    EXPECT_LT(std::abs(change_of(generate(turned_by_angles(testing::box(1, 1, 1e-3)), options).report)), 1e-4);
    options.surface.max_deviation = 0.01;
    EXPECT_LT(std::abs(change_of(generate(turned_by_angles(testing::box(1, 1, 1e-3)), options).report)), 1e-4);
  }
}

/// What the stages around the surface front see.
struct Bench {
  Options options;
  RunContext context;
  octafront::Run run{options, context};
  Prepared input = prepare(testing::icosphere(2), run);
  StageReport report;
  Stage stage{context, report};

  Remeshed scaled_by(double factor) const {
    Remeshed made = input_as_it_is(input.surface, SizeField::uniform(0.3));
    for (Vec3& p : made.surface.points) p = p * factor;
    return made;
  }
};

TEST(KeptShape, ASurfaceThatLosesVolumeIsMadeAgainBySmallerSizes) {
  Bench bench;
  std::vector<double> sizes;
  const Remeshed made =
      remeshed_in_shape(bench.input, SizeField::uniform(0.3), bench.run, bench.stage, [&](const SizeField& by) {
        sizes.push_back(by.at({0, 0, 1}));
        return bench.scaled_by(sizes.size() == 1 ? 0.98 : 0.999);
      });
  ASSERT_EQ(sizes.size(), 2u);
  EXPECT_LT(sizes[1], sizes[0]);
  EXPECT_NEAR(enclosed_volume(made.surface) / bench.run.report.input_volume, 0.997, 1e-5);
  EXPECT_EQ(bench.report.notes.size(), 1u);
}

/// The finished mesh gives it back.
TEST(KeptShape, ALittleVolumeIsOwed) {
  Bench bench;
  int made = 0;
  const auto make = [&](const SizeField&) {
    ++made;
    return bench.scaled_by(0.99);
  };
  const Remeshed result = remeshed_in_shape(bench.input, SizeField::uniform(0.3), bench.run, bench.stage, make);
  EXPECT_EQ(made, 1);
  EXPECT_TRUE(owes_volume(bench.input, result, bench.run));
  EXPECT_FALSE(owes_volume(bench.input, bench.scaled_by(0.999), bench.run));
}

/// Coarse elements cut off 3 % of a ball.
TEST(KeptShape, TheMeshGetsTheVolumeBack) {
  Options options;
  options.size.automatic_factor = 2;
  const Report report = generate(testing::icosphere(4), options).report;
  EXPECT_LT(std::abs(change_of(report)), 1e-3);
  EXPECT_LT(report.tets, 4000u);
}

TEST(KeptShape, TheInputsTrianglesAreKeptWhereNothingHelps) {
  Bench bench;
  const Remeshed made = remeshed_in_shape(bench.input, SizeField::uniform(0.3), bench.run, bench.stage,
                                          [&](const SizeField&) { return bench.scaled_by(0.9); });
  EXPECT_EQ(made.surface, bench.input.surface.mesh());
}

TEST(KeptShape, NoSurfaceIsMadeInVainWhereNoSizesWithinTheBudgetKeepTheVolume) {
  Bench bench;
  const SizeField coarse = SizeField::uniform(0.75);  // loses a fifth of a ball's volume
  for (const double budget : {30.0, 1e6}) {
    int made = 0;
    const auto make = [&](const SizeField&) {
      ++made;
      return bench.scaled_by(1);
    };
    const Remeshed result = remeshed_in_shape(bench.input, coarse, bench.run, bench.stage, make, budget);
    EXPECT_EQ(made, budget < 100 ? 0 : 1) << budget;
    EXPECT_EQ(result.stays, budget < 100) << budget;
    EXPECT_EQ(result.surface, bench.input.surface.mesh());
  }
}

TEST(KeptShape, ABoundaryThatStaysIsNotMovedByImprovement) {
  Bench bench;
  Remeshed kept = bench.scaled_by(1);
  kept.stays = true;
  const SurfaceMesh before = kept.surface;
  Filled filled = fill_surface(bench.input, std::move(kept), bench.run);
  improve_in_shape(bench.input, filled, bench.run);
  EXPECT_EQ(filled.boundary.surface, before);
  EXPECT_EQ(bench.run.report.stages.back().name, "improve");
}

TEST(KeptShape, ABodyThatIsNotTheInputIsNotHandedOut) {
  Bench bench;
  EXPECT_NO_THROW(check_shape(bench.input, {{}, bench.scaled_by(1.02)}, bench.run));
  EXPECT_THROW(check_shape(bench.input, {{}, bench.scaled_by(1.04)}, bench.run), MeshingError);
  Filled moved{{}, bench.scaled_by(1)};
  for (Vec3& p : moved.boundary.surface.points) p.x += 0.1;
  EXPECT_THROW(check_shape(bench.input, moved, bench.run), MeshingError);
}

TEST(KeptShape, SizesOfTheUsersOwnAreNotRefused) {
  Bench bench;
  Options coarse;
  coarse.size.size = 1;
  octafront::Run run(coarse, bench.context);
  run.report.input_volume = bench.run.report.input_volume;
  EXPECT_NO_THROW(check_shape(bench.input, {{}, bench.scaled_by(0.9)}, run));
}

}  // namespace
}  // namespace octafront
