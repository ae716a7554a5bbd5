#include "pipeline/stages/stages.h"

#include <octafront/error.h>
#include <octafront/generate.h>
#include <octafront/validity.h>

#include "pipeline/stages/measure.h"
#include "support/named_surfaces.h"

#include <cmath>

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

TEST(MeshHash, TellsWhatIsWhere) {
  TetMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  mesh.tets = {{0, 1, 2, 3}, {1, 2, 3, 4}};
  mesh.region = {0, 1};
  const auto changed = [&](const auto& change) {
    TetMesh other = mesh;
    change(other);
    return mesh_hash(other);
  };
  EXPECT_EQ(changed([](TetMesh&) {}), mesh_hash(mesh));
  EXPECT_NE(changed([](TetMesh& m) { std::swap(m.tets[0], m.tets[1]); }), mesh_hash(mesh));
  EXPECT_NE(changed([](TetMesh& m) { std::swap(m.tets[0][0], m.tets[0][1]); }), mesh_hash(mesh));
  EXPECT_NE(changed([](TetMesh& m) { std::swap(m.points[0], m.points[1]); }), mesh_hash(mesh));
  EXPECT_NE(changed([](TetMesh& m) { std::swap(m.region[0], m.region[1]); }), mesh_hash(mesh));
  EXPECT_NE(changed([](TetMesh& m) { m.points[4].x = std::nextafter(1.0, 2.0); }), mesh_hash(mesh));
  EXPECT_NE(changed([](TetMesh& m) { m.region = {0, 0}; }), changed([](TetMesh& m) { m.region = {1, 1}; }));
  EXPECT_NE(changed([](TetMesh& m) {
              m.boundary = {{0, 1, 2}};
            }),
            changed([](TetMesh& m) {
              m.interfaces = {{0, 1, 2}};
            }));
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

TEST(Stages, OneMissingTriangleCostsNoElements) {
  SurfaceMesh holed = testing::icosphere(4);
  const double whole = static_cast<double>(generate(holed).report.tets);
  holed.triangles.erase(holed.triangles.begin() + 40);
  const Mended mended = mend_surface(holed);
  const Result made = generate(mended);
  EXPECT_NEAR(static_cast<double>(made.report.tets) / whole, 1, 0.1);
}

TEST(Stages, WhatRepairClosedIsAPatchOfTheMesh) {
  SurfaceMesh open = testing::icosphere(4);
  std::erase_if(open.triangles, [&](const Triangle& t) { return open.points[t[0]].z > 0.7; });
  const Result made = generate(mend_surface(open));
  ASSERT_FALSE(made.mesh.patch_names.empty());
  EXPECT_EQ(made.mesh.patch_names.back(), kClosedByRepair);
  const auto closed = static_cast<std::uint32_t>(made.mesh.patch_names.size() - 1);
  std::size_t count = 0;
  for (std::size_t t = 0; t < made.mesh.boundary.size(); ++t) {
    const Vec3 p = made.mesh.points[made.mesh.boundary[t][0]];
    if (made.mesh.patch[t] == closed) {
      ++count;
      EXPECT_GT(p.z, 0.5);
    } else {
      EXPECT_LT(p.z, 0.8);
    }
  }
  EXPECT_GT(count, 20u);
  EXPECT_EQ(generate_surface(mend_surface(open)).surface.patch_names, made.mesh.patch_names);
}

TEST(Stages, BoundsOfAMendedSurfaceFollowItsTriangles) {
  Mended mended{testing::icosphere(4), {}, {}};
  const double loose = static_cast<double>(generate(mended).report.tets);
  const std::size_t triangles = mended.surface.triangles.size();
  mended.bound.assign(triangles, HUGE_VAL);
  for (std::size_t t = 0; t < triangles; ++t)
    if (mended.surface.points[mended.surface.triangles[t][0]].z > 0.9) mended.bound[t] = 3e-3;
  for (std::uint32_t t = 0; t < triangles; ++t) mended.surface.source.push_back(7 * t);
  const Result made = generate(mended);
  EXPECT_GT(static_cast<double>(made.report.tets), 1.02 * loose);
  EXPECT_LT(static_cast<double>(made.report.tets), 2.5 * loose);
  for (const std::uint32_t source : made.mesh.source) EXPECT_EQ(source % 7, 0u);
  // A bound of the user's holds everywhere.
  Options options;
  options.surface.max_deviation = 0.02;
  EXPECT_EQ(generate(mended, options).report.hash, generate(mended.surface, options).report.hash);

  mended.bound.pop_back();
  EXPECT_THROW(generate(mended), OptionError);
  mended.bound.push_back(0);
  EXPECT_THROW(generate(mended), OptionError);
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
