// One mesh, whoever makes it: virtual ranks share the work, and what goes wrong on one of them ends all.

#include <octafront/error.h>
#include <octafront/generate.h>
#include <octafront/validity.h>

#include "base/comm/virtual_ranks.h"
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

TEST(Ranks, MakeTheSameComplex) {
  expect_same_mesh(testing::packed_spheres(2, 1).surface, ranks_options(0.08), {2, 5});
}

TEST(Ranks, FillTheSameKeptSurface) {
  Options options = ranks_options(0.1);
  options.surface.keep = true;
  expect_same_mesh(testing::icosphere(4), options, {3});
}

TEST(Ranks, MeetTheSameNumberOfElements) {
  Options options;
  options.size.elements = 30'000;
  options.order = 2;
  expect_same_mesh(testing::icosphere(4), options, {2});
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
