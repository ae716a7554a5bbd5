// One mesh, whoever makes it: virtual ranks share the work, and what goes wrong on one of them ends all.

#include <octafront/error.h>
#include <octafront/generate.h>
#include <octafront/validity.h>

#include "base/shared/virtual_ranks.h"
#include "support/complexes.h"
#include "support/named_surfaces.h"

#include <functional>
#include <mutex>
#include <new>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

Options ranks_options(double size) {
  Options o;
  o.size.size = size;
  return o;
}

/// That so many ranks make what a process alone makes; and that they share the work.
void expect_same_mesh(const SurfaceMesh& surface, const Options& options, const std::vector<int>& counts) {
  const Result alone = generate(surface, options);
  EXPECT_EQ(first_defect(alone.mesh), std::nullopt);
  for (const int count : counts)
    for (const int threads : {1, 2})
      run_virtual_ranks(count, [&](Ranks& ranks) {
        RunContext context;
        context.ranks = &ranks;
        context.threads = threads;
        const Result made = generate(surface, options, context);
        EXPECT_EQ(made.report.hash, alone.report.hash) << count << " ranks, " << threads << " threads";
        EXPECT_EQ(made.mesh, alone.mesh);
        EXPECT_EQ(ranks.use.bytes_taken > 50'000u, count > 1);
      });
}

TEST(Ranks, MakeTheMeshOfAProcessAlone) {
  expect_same_mesh(testing::torus(80, 40), ranks_options(0.09), {1, 2, 3, 5, 8});
}

/// Small, for sanitizers: all stages, ranks and threads at the same time.
TEST(Ranks, MakeASmallMeshByThreadsOfEach) {
  const SurfaceMesh torus = testing::torus(24, 12);
  const std::uint64_t alone = generate(torus, ranks_options(0.15)).report.hash;
  run_virtual_ranks(3, [&](Ranks& ranks) {
    RunContext context;
    context.ranks = &ranks;
    context.threads = 2;
    EXPECT_EQ(generate(torus, ranks_options(0.15), context).report.hash, alone);
    EXPECT_GT(ranks.use.seconds_shared, 0);
  });
}

TEST(Ranks, MakeTheSameComplex) {
  expect_same_mesh(testing::packed_spheres(2, 1).surface, ranks_options(0.1), {1, 2, 3, 5, 8});
}

TEST(Ranks, FillTheSameKeptSurface) {
  Options options = ranks_options(0.13);
  options.surface.keep = true;
  expect_same_mesh(testing::icosphere(4), options, {1, 2, 3, 5, 8});
}

/// Not all that they do is shared, yet all is the same.
TEST(Ranks, MakeTheSameMeshByAllOptions) {
  struct Case {
    std::string name;
    SurfaceMesh surface;
    Options options;
  };
  std::vector<Case> cases;
  const auto add = [&](const char* name, SurfaceMesh surface, double size) -> Options& {
    return cases.emplace_back(Case{name, std::move(surface), ranks_options(size)}).options;
  };
  add("classical front", testing::icosphere(2), 0.3).method = Method::kAft;
  add("stuffing", testing::torus(24, 12), 0.2).method = Method::kOctree;
  add("recovery", testing::torus(16, 8), 0.5).method = Method::kRecover;
  Options& layers = add("layers", testing::cube(1), 0.15);
  layers.layers.count = 2, layers.layers.first_part = 0.2;
  add("shell", testing::box(1, 1, 0.02), 0.12).volume.shell = 2;
  add("graded", testing::cube(1), 0.06).size.interior = SizeOptions::Interior::kGraded;
  add("no improvement", testing::torus(24, 12), 0.12).improve.level = ImproveOptions::Level::kOff;
  add("most improvement", testing::torus(24, 12), 0.2).improve.level = ImproveOptions::Level::kBest;
  add("no lattice", testing::icosphere(3), 0.2).volume.core = VolumeOptions::Core::kOff;
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    const Result alone = generate(c.surface, c.options);
    run_virtual_ranks(3, [&](Ranks& ranks) {
      RunContext context;
      context.ranks = &ranks;
      context.threads = 1;
      EXPECT_EQ(generate(c.surface, c.options, context).mesh, alone.mesh) << "rank " << ranks.rank();
    });
  }
}

TEST(Ranks, MeetTheSameNumberOfElements) {
  Options options;
  options.size.elements = 30'000;
  options.order = 2;
  expect_same_mesh(testing::icosphere(4), options, {2});
}

/// That the shares of so many ranks are the stretches of what a process alone makes, and all reports the same.
void expect_same_shares(const SurfaceMesh& surface, const Options& options, int count) {
  const Result alone = generate(surface, options);
  std::vector<TetMesh> shares(static_cast<std::size_t>(count));
  run_virtual_ranks(count, [&](Ranks& ranks) {
    RunContext context;
    context.ranks = &ranks;
    ranks.shares_tets = true;
    Result made = generate(surface, options, context);
    EXPECT_TRUE(made.is_share);
    const Report &here = made.report, &there = alone.report;
    EXPECT_EQ(here.hash, there.hash);
    EXPECT_EQ(here.tets, there.tets);
    EXPECT_EQ(here.quality.beta_mean, there.quality.beta_mean);
    EXPECT_EQ(here.quality.beta_min_tet, there.quality.beta_min_tet);
    EXPECT_EQ(here.quality.dihedral_histogram, there.quality.dihedral_histogram);
    EXPECT_EQ(here.volume_edges.mean_ratio, there.volume_edges.mean_ratio);
    ASSERT_EQ(here.regions.size(), there.regions.size());
    for (std::size_t r = 0; r < here.regions.size(); ++r) {
      EXPECT_EQ(here.regions[r].quality.elements, there.regions[r].quality.elements);
      EXPECT_NEAR(here.regions[r].volume, there.regions[r].volume, 1e-12 * there.regions[r].volume);
    }
    shares[static_cast<std::size_t>(ranks.rank())] = std::move(made.mesh);
  });
  TetMesh all = shares[0];
  all.tets.clear(), all.region.clear();
  for (const TetMesh& share : shares) {
    EXPECT_LT(share.tets.size(), 3 * alone.mesh.tets.size() / static_cast<std::size_t>(count));
    all.tets.insert(all.tets.end(), share.tets.begin(), share.tets.end());
    all.region.insert(all.region.end(), share.region.begin(), share.region.end());
  }
  EXPECT_EQ(all, alone.mesh);
}

TEST(Ranks, GetSharesOfTheMesh) {
  for (const int count : {2, 5}) expect_same_shares(testing::torus(80, 40), ranks_options(0.07), count);
}

TEST(Ranks, GetSharesOfSeveralBodies) {
  const SurfaceMesh body = testing::icosphere(3);
  const SurfaceMesh two = testing::joined(body, testing::transformed(body, 1, {3, 0, 0}));
  expect_same_shares(two, ranks_options(0.12), 3);
}

/// Sheets that nearly touch: cavities stay open, flat elements are raised.
TEST(Ranks, GetSharesWhereTheFrontStaysOpen) {
  Options options = ranks_options(0.15);
  options.surface.keep = true;
  SurfaceMesh ball = testing::icosphere(4);
  for (Vec3& p : ball.points) p.z *= p.z > 0 ? 0.02 : 1;
  const Result alone = generate(ball, options);
  double cavities = 0;
  for (const StageReport& stage : alone.report.stages)
    for (const auto& [name, count] : stage.counters)
      if (name == "cavities") cavities += count;
  EXPECT_GT(cavities, 0);
  expect_same_shares(ball, options, 3);
}

std::vector<std::string> stages_of(const SurfaceMesh& surface, const Options& options) {
  std::vector<std::string> stages;
  RunContext context;
  context.progress = [&](std::string_view stage, double) {
    if (stages.empty() || stages.back() != stage) stages.emplace_back(stage);
  };
  generate(surface, options, context);
  return stages;
}

/// What came of a run in which one rank throws as a stage begins.
std::string error_with(int failing, const std::string& at, const std::function<void()>& raise,
                       const SurfaceMesh& surface, const Options& options) {
  std::mutex mutex;
  std::set<std::string> errors;
  run_virtual_ranks(3, [&](Ranks& ranks) {
    RunContext context;
    context.ranks = &ranks;
    context.progress = [&](std::string_view stage, double) {
      if (ranks.rank() == failing && stage == at) raise();
    };
    std::string error = "none";
    try {
      generate(surface, options, context);
    } catch (const RankFailure& e) {
      error = e.what();
    } catch (const Cancelled&) {
      error = "cancelled";
    }
    const std::lock_guard lock(mutex);
    errors.insert(error);
  });
  EXPECT_EQ(errors.size(), 1u) << "ranks end differently in " << at;
  return *errors.begin();
}

TEST(Ranks, WhatFailsOnOneEndsAllWithOneError) {
  const SurfaceMesh surface = testing::icosphere(4);
  const Options options = ranks_options(0.12);
  const std::vector<std::string> stages = stages_of(surface, options);
  EXPECT_GE(stages.size(), 5u);
  for (const std::string& stage : stages)
    for (const int rank : {0, 1, 2}) {
      SCOPED_TRACE(stage + " on rank " + std::to_string(rank));
      const std::string where = "rank " + std::to_string(rank) + " of 3, in stage \"" + stage + "\": ";
      const auto error = [&](const std::function<void()>& raise) {
        return error_with(rank, stage, raise, surface, options);
      };
      EXPECT_EQ(error([] { throw std::bad_alloc(); }), where + "out of memory");
      EXPECT_EQ(error([] { throw MeshingError("no way"); }), where + "no way");
      EXPECT_EQ(error([] { throw Cancelled(); }), "cancelled");
    }
}

TEST(Ranks, OtherInputOnOneRankIsFoundOut) {
  EXPECT_THROW(run_virtual_ranks(3,
                                 [](Ranks& ranks) {
                                   RunContext context;
                                   context.ranks = &ranks;
                                   generate(testing::icosphere(ranks.rank() == 1 ? 3 : 2), ranks_options(0.5), context);
                                 }),
               RankFailure);
}

TEST(Ranks, OtherOptionsOnOneRankAreFoundOut) {
  EXPECT_THROW(run_virtual_ranks(2,
                                 [](Ranks& ranks) {
                                   RunContext context;
                                   context.ranks = &ranks;
                                   generate(testing::icosphere(2), ranks_options(ranks.rank() == 1 ? 0.5 : 0.4),
                                            context);
                                 }),
               RankFailure);
}

TEST(Ranks, BoundsOnTimeAreRefused) {
  Options options = ranks_options(0.5);
  options.improve.seconds = 1;
  EXPECT_THROW(run_virtual_ranks(2,
                                 [&](Ranks& ranks) {
                                   RunContext context;
                                   context.ranks = &ranks;
                                   generate(testing::icosphere(2), options, context);
                                 }),
               OptionError);
}

}  // namespace
}  // namespace octafront
