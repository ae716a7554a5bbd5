// A run that was ended goes on from what it has kept, by whomever, to the same mesh.

#include <octafront/error.h>
#include <octafront/generate.h>

#include "base/comm/virtual_ranks.h"
#include "support/complexes.h"
#include "support/named_surfaces.h"
#include "support/test_folder.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

namespace fs = std::filesystem;

struct EndedHere {};
class GoingOn : public testing::InItsFolder {};

Options options_to_keep() {
  Options o;
  o.size.elements = 20'000;
  o.order = 2;
  return o;
}

const Checkpoints kKeep{"kept", false}, kResume{"kept", true};

/// The stages that ran.
std::vector<std::string> stages_run(const Domain& domain, const Checkpoints& checkpoints, const Options& options,
                                    std::uint64_t& hash) {
  std::vector<std::string> stages;
  RunContext context;
  context.progress = [&](std::string_view stage, double) {
    if (stages.empty() || stages.back() != stage) stages.emplace_back(stage);
  };
  hash = generate_with(checkpoints, domain, options, context).report.hash;
  return stages;
}

bool has(const std::vector<std::string>& stages, const char* name) {
  return std::ranges::find(stages, name) != stages.end();
}

TEST_F(GoingOn, ARunThatWasEndedInAnyStageGoesOnToTheSameMesh) {
  for (const SurfaceMesh& surface : {testing::icosphere(4), testing::packed_spheres(2, 1).surface}) {
    const Options options = options_to_keep();
    std::uint64_t alone = 0;
    const std::vector<std::string> stages = stages_run(surface, {}, options, alone);
    int ranks = 0;
    for (const char* ended_in : {"surface front", "volume front", "improve", "second order"}) {
      SCOPED_TRACE(ended_in);
      ASSERT_TRUE(has(stages, ended_in));
      RunContext ended;
      ended.progress = [&](std::string_view stage, double) {
        if (stage == ended_in) throw EndedHere();
      };
      EXPECT_THROW(generate_with(kKeep, surface, options, ended), EndedHere);
      run_virtual_ranks(1 + ranks++ % 3, [&](Ranks& self) {
        RunContext context;
        context.ranks = &self;
        EXPECT_EQ(generate_with(kResume, surface, options, context).report.hash, alone);
      });
    }
  }
}

TEST_F(GoingOn, WhatIsKeptIsNotMadeAgain) {
  const SurfaceMesh surface = testing::icosphere(4);
  std::uint64_t first = 0, again = 0;
  EXPECT_TRUE(has(stages_run(surface, kKeep, options_to_keep(), first), "improve"));
  const std::vector<std::string> stages = stages_run(surface, kResume, options_to_keep(), again);
  EXPECT_EQ(again, first);
  for (const char* kept : {"surface front", "volume front", "improve"}) EXPECT_FALSE(has(stages, kept)) << kept;
  EXPECT_TRUE(has(stages, "second order"));
  // The report is that of the run that made it.
  const Result result = generate_with(kResume, surface, options_to_keep(), {});
  EXPECT_TRUE(std::ranges::any_of(result.report.stages, [](const StageReport& s) { return s.name == "improve"; }));
}

TEST_F(GoingOn, WhatIsDamagedIsMadeAgain) {
  const SurfaceMesh surface = testing::icosphere(3);
  const std::uint64_t whole = generate_with(kKeep, surface, options_to_keep(), {}).report.hash;
  for (const auto& entry : fs::directory_iterator("kept")) {
    if (entry.path().filename() == "run.octafront") continue;
    const auto size = static_cast<std::streamoff>(fs::file_size(entry.path()));
    std::fstream file(entry.path(), std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(size / 2);
    file.put('\x5a'), file.put('\x5a'), file.put('\x5b');
  }
  EXPECT_EQ(generate_with(kResume, surface, options_to_keep(), {}).report.hash, whole);
}

TEST_F(GoingOn, AnotherInputOrOtherOptionsAreRefused) {
  const auto resume = [&](const SurfaceMesh& surface, const Options& options) {
    try {
      generate_with(kResume, surface, options, {});
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  const SurfaceMesh surface = testing::icosphere(2);
  EXPECT_NE(resume(surface, options_to_keep()).find("nothing is kept there"), std::string::npos);
  generate_with(kKeep, surface, options_to_keep(), {});
  EXPECT_NE(resume(testing::icosphere(3), options_to_keep()).find("of another input"), std::string::npos);
  Options other = options_to_keep();
  other.improve.level = ImproveOptions::Level::kFast;
  EXPECT_NE(resume(surface, other).find("by other options"), std::string::npos);
  EXPECT_EQ(resume(surface, options_to_keep()), "none");
}

}  // namespace
}  // namespace octafront
