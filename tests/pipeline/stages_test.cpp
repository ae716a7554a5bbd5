#include "pipeline/stages.h"

#include <octafront/error.h>
#include <octafront/generate.h>
#include <octafront/validity.h>

#include "pipeline/pipeline.h"
#include "support/named_surfaces.h"

#include <gtest/gtest.h>

namespace octafront {
namespace {

Options coarse() {
  Options options;
  options.size.size = 0.25;
  return options;
}

TEST(Stages, OneAfterTheOtherMakeWhatGenerateMakes) {
  const SurfaceMesh torus = testing::torus(24, 12);
  const Options options = coarse();
  const RunContext context;
  octafront::Run run(options, context);
  const Prepared input = prepare(torus, run);
  const SizeField sizes = choose_sizes(input, run);
  Filled filled = fill_to_target(input, sizes, run);
  improve_elements(input, filled, run, run.options.improve);
  check_result(filled.mesh, &filled.boundary.surface, run);
  EXPECT_EQ(mesh_hash(filled.mesh), generate(torus, options).report.hash);
}

TEST(Stages, EachCanBeCalledAlone) {
  const SurfaceMesh cube = testing::cube(4);
  const Options options = coarse();
  const RunContext context;
  octafront::Run first(options, context);
  const Prepared input = prepare(cube, first);
  ASSERT_EQ(first.report.stages.size(), 3U);

  octafront::Run surface(options, context);
  const Remeshed remeshed = triangulate(input, SizeField::uniform(0.2), surface);
  ASSERT_EQ(surface.report.stages.size(), 1U);
  EXPECT_EQ(surface.report.stages[0].name, "surface front");
  EXPECT_NEAR(enclosed_volume(remeshed.surface), 1, 1e-12);

  octafront::Run volume(options, context);
  Filled filled = fill(input, SizeField::uniform(0.2), volume);
  EXPECT_EQ(filled.boundary.surface, remeshed.surface);
  EXPECT_EQ(first_defect(filled.mesh, remeshed.surface), std::nullopt);

  octafront::Run better(options, context);
  const double before = summarize_quality(filled.mesh).beta_mean;
  improve_elements(input, filled, better, better.options.improve);
  EXPECT_GT(summarize_quality(filled.mesh).beta_mean, before);
  EXPECT_EQ(better.report.stages.size(), 1U);
}

TEST(Stages, ARunIsRefusedBeforeItBegins) {
  Options options = coarse();
  options.surface.feature_angle = 200;
  const RunContext context;
  EXPECT_THROW(octafront::Run(options, context), OptionError);
}

TEST(Stages, AWrongBoundaryIsABugOfOurs) {
  const Options options = coarse();
  const RunContext context;
  const Result made = generate(testing::cube(4), options);
  octafront::Run run(options, context);
  const SurfaceMesh other = testing::cube(3);
  EXPECT_THROW(check_result(made.mesh, &other, run), MeshingError);
}

}  // namespace
}  // namespace octafront
